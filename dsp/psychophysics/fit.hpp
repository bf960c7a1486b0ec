// SPDX-License-Identifier: Apache-2.0
// Maximum-likelihood fit of a psychometric function, and how uncertain it is.
#pragma once

#include "dsp/psychophysics/psychometric.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tactus::psychophysics {

/// Answers at one level.
struct LevelCount {
    double level = 0.0;
    double trials = 0.0, correct = 0.0;
};
/// One entry per level, ascending, from single trials.
std::vector<LevelCount> count_levels(std::span<const double> levels, const std::vector<bool>& correct);

struct FitSettings {
    Form form = Form::weibull;
    double guess = 0.5;
    std::optional<double> lapse;  ///< empty: fitted within [0, max_lapse]
    double max_lapse = 0.1;
    std::optional<double> slope;  ///< empty: fitted
    double min_slope = 1e-2, max_slope = 1e3;
};

struct PsychometricFit {
    Psychometric function;
    double log_likelihood = 0.0;  ///< without the binomial coefficients
    double deviance = 0.0;        ///< twice the difference to the saturated model
    /// False where the answers do not exclude (likelihood ratio, 5 %) that the threshold lies beyond any level: all at chance, or
    /// all correct but for lapses. The other numbers then mean nothing.
    bool is_identified = true;
};
/// Log-likelihood of answers under a function.
double log_likelihood(std::span<const LevelCount> counts, const Psychometric& function);
/// Grid, then Nelder and Mead (1965): neither needs derivatives, which vanish where the data separate. Throws Error without
/// answers, for impossible counts, and for levels that are all equal unless the slope is given.
PsychometricFit fit_psychometric(std::span<const LevelCount> counts, const FitSettings& settings);

struct Interval {
    double low = 0.0, high = 0.0;
};
struct BootstrapIntervals {
    Interval threshold, slope;  ///< percentiles; the threshold is the level at which P is `p` of the call
    int failed = 0;  ///< samples whose fit was not identified; they are left out
    double deviance_p = 1.0;  ///< fraction of samples that fit worse than the data: below 0.05 the form is doubtful
};
/// Parametric bootstrap (Wichmann and Hill 2001): answers are drawn from the fitted function at the levels shown, and fitted
/// again. For adaptive methods it ignores that the levels depended on the answers.
BootstrapIntervals bootstrap_fit(std::span<const LevelCount> counts, const FitSettings& settings,
                                 const PsychometricFit& fit, double p, int samples = 999, double confidence = 0.95,
                                 std::uint64_t seed = 1);

}  // namespace tactus::psychophysics
