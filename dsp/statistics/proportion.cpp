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

std::pair<double, double> paired_difference_interval(const PairedOutcomes& pairs, double confidence) {
    const std::size_t trials = pairs.both + pairs.first_only + pairs.second_only + pairs.neither;
    if (trials == 0) return {-1.0, 1.0};
    const double n = static_cast<double>(trials), e = static_cast<double>(pairs.both),
                 f = static_cast<double>(pairs.first_only), g = static_cast<double>(pairs.second_only),
                 h = static_cast<double>(pairs.neither);
    const double p1 = (e + f) / n, p2 = (e + g) / n;
    const auto [low1, high1] = wilson_interval(pairs.both + pairs.first_only, trials, confidence);
    const auto [low2, high2] = wilson_interval(pairs.both + pairs.second_only, trials, confidence);
    // Correlation, with a continuity correction where it is positive.
    const double margins = std::sqrt((e + f) * (g + h) * (e + g) * (f + h));
    double product = e * h - f * g;
    if (product > 0.0) product = std::max(0.0, product - 0.5 * n);
    const double phi = margins > 0.0 ? product / margins : 0.0;
    const auto width = [phi](double a, double b) {
        return std::sqrt(std::max(0.0, a * a - 2.0 * phi * a * b + b * b));
    };
    return {std::max(-1.0, p1 - p2 - width(p1 - low1, high2 - p2)),
            std::min(1.0, p1 - p2 + width(high1 - p1, p2 - low2))};
}

}  // namespace tactus::statistics
