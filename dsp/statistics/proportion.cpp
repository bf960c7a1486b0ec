// SPDX-License-Identifier: Apache-2.0
#include "dsp/statistics/proportion.hpp"

#include "dsp/statistics/distributions.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::statistics {

std::pair<double, double> wilson_interval(std::size_t successes, std::size_t trials, double confidence) {
    if (trials == 0) return {0.0, 1.0};
    const double n = static_cast<double>(trials), p = static_cast<double>(successes) / n;
    const double z = normal_quantile(0.5 + 0.5 * confidence), scale = 1.0 / (1.0 + z * z / n);
    const double centre = scale * (p + 0.5 * z * z / n);
    const double half = scale * z * std::sqrt(p * (1.0 - p) / n + 0.25 * z * z / (n * n));
    return {successes == 0 ? 0.0 : std::max(0.0, centre - half),
            successes == trials ? 1.0 : std::min(1.0, centre + half)};
}

}  // namespace tactus::statistics
