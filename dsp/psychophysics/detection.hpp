// SPDX-License-Identifier: Apache-2.0
// Signal detection: sensitivity d′ and criterion c of equal-variance Gaussian observers (Macmillan and Creelman 2005).
#pragma once

namespace tactus::psychophysics {

struct Detection {
    double d_prime = 0.0;
    double criterion = 0.0;  ///< above 0: the subject says "no" too often
};
/// Yes/no task. Half a count is added to hits and false alarms and one to both numbers of trials (Hautus 1995), so that
/// perfect subjects have a finite d′. Throws Error for counts that are negative, or without trials of one kind.
Detection yes_no(double hits, double signals, double false_alarms, double noises);

/// d′ from the fraction of correct answers among `alternatives` ≥ 2 intervals, without bias. Solved by bisection: no closed form
/// exists above two. Throws Error unless 0 < correct < 1; negative below chance for two, 0 below chance for more.
double d_prime_of_choice(double correct, int alternatives);
/// Its inverse: ∫ φ(x − d′) Φ(x)^(m−1) dx.
double correct_of_choice(double d_prime, int alternatives);

/// Same–different task, independent observations and no bias: p = Φ(d′/2)² + Φ(−d′/2)². 0 below chance.
double d_prime_of_same_different(double correct);

}  // namespace tactus::psychophysics
