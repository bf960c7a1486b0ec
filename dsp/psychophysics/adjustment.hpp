// SPDX-License-Identifier: Apache-2.0
// Method of adjustment: the subject turns the level until it matches, starting at either end of the range (Gescheider 1997,
// chapter 3).
#pragma once

#include "dsp/psychophysics/fit.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace tactus::psychophysics {

/// Matches of one subject in one condition, on the axis of the stimulus.
struct AdjustedLevel {
    std::size_t below_count = 0, above_count = 0;  ///< trials that began below and above
    double below = 0.0, above = 0.0;  ///< mean match of each
    /// Mean of both directions, so that stopping early, which shifts them against each other, cancels.
    double match = 0.0;
    double deviation = 0.0;  ///< standard deviation of a match about the mean of its direction, pooled
    Interval interval;  ///< of `match`, by Student's t
};

/// None unless both directions have a match and there are three in all.
std::optional<AdjustedLevel> adjusted_level(std::span<const double> matches, const std::vector<bool>& began_above,
                                            double confidence = 0.95);

}  // namespace tactus::psychophysics
