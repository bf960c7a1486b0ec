// SPDX-License-Identifier: Apache-2.0
// Level with a given probability, from answers whose levels depended on the answers before.
#pragma once

#include "dsp/psychophysics/fit.hpp"

#include <span>
#include <vector>

namespace tactus::psychophysics {

/// Uniform prior of the level within [low, high] and of the slopes of a list.
struct PosteriorSettings {
    Form form = Form::weibull;
    double guess = 0.5, lapse = 0.02;
    std::vector<double> slopes;
    double low = -1.0, high = 1.0;
};

struct PosteriorLevel {
    double median = 0.0;
    Interval interval;  ///< equal tails
};

/// Median of the posterior. After a staircase the maximum of the likelihood lies 2 to 4 % too low at 60 trials, because runs of lucky
/// guesses lower the level that is shown next; the median does not (`tactus bench experiments`). The likelihood does not depend on
/// the rule that chose the levels, so that the interval holds for adaptive methods, where a bootstrap at fixed levels is too narrow.
/// Throws Error without answers or slopes, for a range that is not ascending, and for a `p` that no level has.
PosteriorLevel posterior_level(std::span<const LevelCount> counts, const PosteriorSettings& settings, double p,
                               double confidence = 0.95);

}  // namespace tactus::psychophysics
