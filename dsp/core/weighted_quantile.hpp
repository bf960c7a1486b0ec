// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace tactus {

/// The value below which `share` (0 to 1) of the weights lie. `values` and `weights` have the same length, at least 1.
inline double weighted_quantile(const std::vector<double>& values, const std::vector<double>& weights, double share) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t n) { return values[n]; });
    const double wanted = share * std::accumulate(weights.begin(), weights.end(), 0.0);
    double sum = 0.0;
    for (const std::size_t n : order)
        if ((sum += weights[n]) >= wanted) return values[n];
    return values[order.back()];
}

}  // namespace tactus
