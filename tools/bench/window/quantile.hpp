// SPDX-License-Identifier: Apache-2.0
// Quantiles of what a benchmark measured.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tactus::bench {

/// The value that stands at `q` of the sorted ones, 0 to 1, nearest rank; 0 without values.
inline double quantile(std::vector<double> values, double q) {
    if (values.empty()) return 0.0;
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
}

}  // namespace tactus::bench
