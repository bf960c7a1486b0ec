// SPDX-License-Identifier: Apache-2.0
// Distributions that the tests of an experiment need. Offline: nothing here is called in a tick.
#pragma once

#include <functional>

namespace tactus::statistics {

/// Standard normal density.
double normal_density(double x);
/// Standard normal distribution, by erfc: accurate in both tails.
double normal_cdf(double x);
/// Inverse of normal_cdf for 0 < p < 1; −∞ at 0, +∞ at 1. Abramowitz and Stegun 26.2.23, then Halley steps.
double normal_quantile(double p);

/// Regularised incomplete beta function I_x(a, b), a, b > 0 and 0 ≤ x ≤ 1, by Lentz's continued fraction (DLMF 8.17.22).
double incomplete_beta(double a, double b, double x);

/// Student's t with `freedom` > 0 degrees of freedom.
double student_cdf(double t, double freedom);
/// Two-sided p-value of |t|: keeps its relative accuracy where 1 − cdf would cancel.
double student_two_sided(double t, double freedom);
/// Inverse of student_cdf for 0 < p < 1.
double student_quantile(double p, double freedom);

/// Mean of f(s) where s = √(χ²/freedom): how much a sample's standard deviation exceeds the true one. Powers of t tests
/// are such means of normal probabilities. Simpson's rule on 600 intervals; freedom ≥ 1.
double mean_over_deviation(double freedom, const std::function<double(double)>& f);

/// Non-central t: probability of T ≤ t when the true mean is `shift` standard errors from 0.
double noncentral_student_cdf(double t, double freedom, double shift);

}  // namespace tactus::statistics
