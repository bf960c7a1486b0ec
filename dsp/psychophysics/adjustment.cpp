// SPDX-License-Identifier: Apache-2.0
#include "dsp/psychophysics/adjustment.hpp"

#include "dsp/statistics/distributions.hpp"
#include "dsp/statistics/paired.hpp"

#include <array>
#include <cmath>

namespace tactus::psychophysics {

std::optional<AdjustedLevel> adjusted_level(std::span<const double> matches, const std::vector<bool>& began_above,
                                            double confidence) {
    std::array<std::vector<double>, 2> directions;
    for (std::size_t i = 0; i < matches.size(); ++i) directions[began_above[i] ? 1 : 0].push_back(matches[i]);
    const statistics::Moments below = statistics::moments(directions[0]), above = statistics::moments(directions[1]);
    if (below.count == 0 || above.count == 0 || matches.size() < 3) return std::nullopt;
    const double n0 = static_cast<double>(below.count), n1 = static_cast<double>(above.count), freedom = n0 + n1 - 2.0;
    AdjustedLevel result;
    result.below_count = below.count;
    result.above_count = above.count;
    result.below = below.mean;
    result.above = above.mean;
    result.match = 0.5 * (below.mean + above.mean);
    result.deviation = std::sqrt(
        ((n0 - 1.0) * below.deviation * below.deviation + (n1 - 1.0) * above.deviation * above.deviation) / freedom);
    const double reach = 0.5 * result.deviation * std::sqrt(1.0 / n0 + 1.0 / n1) *
                         statistics::student_quantile(0.5 + 0.5 * confidence, freedom);
    result.interval = {result.match - reach, result.match + reach};
    return result;
}

}  // namespace tactus::psychophysics
