// SPDX-License-Identifier: Apache-2.0
// The psychometric function: probability of a response against the level of a stimulus.
#pragma once

#include <cstdint>
#include <vector>

namespace tactus::psychophysics {

/// Shape of the core F, from 0 to 1. Levels of `weibull` are log10 of the stimulus: there it is 1 − exp(−(s/threshold)^slope).
enum class Form : std::uint8_t { logistic, weibull, normal };

/// P(x) = guess + (1 − guess − lapse) F(x) (Wichmann and Hill 2001). `x` and `threshold` are levels: the stimulus itself or
/// its log10, as the experiment states.
struct Psychometric {
    Form form = Form::weibull;
    double threshold = 0.0;  ///< where F is 1/2 (logistic, normal) or 1 − 1/e (weibull)
    /// logistic: 1/(1 + exp(−slope (x − threshold))); weibull: exponent; normal: 1/standard deviation. Above 0.
    double slope = 1.0;
    double guess = 0.5;  ///< response rate without stimulus: 1/m of m alternatives
    double lapse = 0.0;  ///< misses however strong the stimulus is

    double core(double x) const;
    double at(double x) const { return guess + (1.0 - guess - lapse) * core(x); }
    /// Level at which P is `p`; NaN outside of (guess, 1 − lapse).
    double level_of(double p) const;
};

/// Four slopes from shallow to steep, for a prior: F rises from 25 to 75 % within 0.68, 0.34, 0.20 and 0.14 of `scale`, in every
/// form. `scale`: a decade on an axis of logarithms, the range of the stimulus on a linear one.
std::vector<double> usual_slopes(Form form, double scale = 1.0);

}  // namespace tactus::psychophysics
