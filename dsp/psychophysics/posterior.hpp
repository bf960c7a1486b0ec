// SPDX-License-Identifier: Apache-2.0
// Level with a given probability, from adaptive trials.
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

/// Prior of the analysis of a stimulus whose levels lie in [low, high], for subjects whose slopes QUEST+ expects at `slopes`,
/// which ascend: slopes in equal ratios from the least of them to four times the greatest, and half of the range more at each end,
/// so that its ends do not attract the median. Throws Error without slopes.
PosteriorSettings threshold_prior(Form form, double guess, double lapse, std::span<const double> slopes, double low,
                                  double high);

struct PosteriorLevel {
    double median = 0.0;
    Interval interval;  ///< equal tails
};

/// Median of the posterior. The likelihood does not depend on the rule that chose the levels, so that the interval holds for
/// adaptive methods, where a bootstrap at fixed levels is too narrow. The median depends on the prior of the slopes: observers with
/// a shallow slope get a level that is too high, those with a steep one a level that is too low, by a few percent after 60 trials
/// (`tactus bench experiments` states it for several slopes).
/// Throws Error without answers or slopes, for a range that is not ascending, and for a `p` that no level has.
PosteriorLevel posterior_level(std::span<const LevelCount> counts, const PosteriorSettings& settings, double p,
                               double confidence = 0.95);

}  // namespace tactus::psychophysics
