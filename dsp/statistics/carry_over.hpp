// SPDX-License-Identifier: Apache-2.0
// Effect of a treatment in a cross-over of several periods, adjusted for what a treatment leaves behind in the next period.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::statistics {

/// What one subject did in one period.
struct PeriodValue {
    std::size_t subject = 0, period = 0, treatment = 0;  ///< indices from 0
    double value = 0.0;
    double carried = 0.0;  ///< regressor of the carry-over: of the treatment in the period before, 0 in the first
};

struct CarryOver {
    double effect = 0.0, low = 0.0, high = 0.0, p = 1.0;  ///< the contrast of treatments, adjusted
    double carried = 0.0, carried_low = 0.0, carried_high = 0.0, carried_p = 1.0;  ///< per unit of `carried`
    double freedom = 0.0;
    /// Variance of the effect over that of the same model without carry-over, for equal residuals: a property of the design
    /// alone. 11/7 for the mode of the co-location study of 16 subjects.
    double variance_factor = 1.0;
};

/// Least squares of value = subject + period + treatment + carry-over (Jones and Kenward 2014, chapter 5). `contrast` has a weight
/// for each treatment; they add up to 0. Throws Error when the design cannot separate these terms, as when all subjects have the
/// same order, and when no residual is left.
CarryOver carry_over(std::span<const PeriodValue> values, const std::vector<double>& contrast,
                     double confidence = 0.95);

}  // namespace tactus::statistics
