// SPDX-License-Identifier: Apache-2.0
// Tests of paired differences: one number per subject, condition B minus condition A.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tactus::statistics {

struct Moments {
    std::size_t count = 0;
    double mean = 0.0;
    double deviation = 0.0;  ///< standard deviation of the sample, n − 1; 0 for fewer than two values
};
/// Two passes: no cancellation for values far from 0.
Moments moments(std::span<const double> values);

struct PairedTest {
    Moments of;
    double t = 0.0, freedom = 0.0;
    double p = 1.0;                ///< two-sided
    double low = 0.0, high = 0.0;  ///< confidence interval of the mean difference
};
/// Paired t test. Throws Error for fewer than two differences, for one that is not finite, and when all are equal: then
/// the interval has no width, and t no value.
PairedTest paired_t(std::span<const double> differences, double confidence = 0.95);

struct PermutationTest {
    double p = 1.0;  ///< two-sided, of the mean
    std::uint64_t arrangements = 0;
    bool is_exact = false;  ///< all arrangements of signs were tried
};
/// Sign-flip test: under the null hypothesis the sign of each difference is arbitrary. All 2^n arrangements up to n = 20;
/// above, `draws` random ones, and p = (b + 1)/(draws + 1) (Phipson and Smyth 2010), so that it is never 0. It needs no
/// normal distribution, but symmetry.
PermutationTest permutation_test(std::span<const double> differences, std::uint64_t seed = 1,
                                 std::uint64_t draws = 20'000);

/// Holm's step-down adjustment (1979): adjusted p-values in the order given. Controls the family-wise error without
/// assumptions on dependence, and rejects whatever Bonferroni rejects.
std::vector<double> holm(std::span<const double> p);

enum class Equivalence : std::uint8_t { equivalent, inconclusive, different };
struct EquivalenceTest {
    double p = 1.0;  ///< larger of the two one-sided tests
    double low = 0.0, high = 0.0;  ///< interval of confidence 1 − 2 alpha
    /// different: the whole interval lies beyond one margin. An effect inside the margin that is significantly not zero is
    /// equivalent nevertheless.
    Equivalence verdict = Equivalence::inconclusive;
};
/// Two one-sided tests (Schuirmann 1987) against ±margin, which is in the unit of the differences. Throws Error as paired_t, or
/// for a margin that is not positive.
EquivalenceTest equivalence_test(std::span<const double> differences, double margin, double alpha = 0.05);

/// The same with a margin in standard deviations of the differences, which are not known beforehand: the t statistic against the
/// non-central t at the margin (Wellek 2010, section 5.3). The test above with margin times the sample's deviation would not
/// have the size alpha, because that margin is random. The result has no interval. Throws Error as paired_t, or for a
/// margin that is not positive.
EquivalenceTest standardised_equivalence(std::span<const double> differences, double margin, double alpha = 0.05);
/// Confidence interval of the mean over the deviation: those effects that t does not exclude (Steiger and Fouladi 1997).
/// Throws Error as paired_t.
std::pair<double, double> standardised_interval(std::span<const double> differences, double confidence = 0.9);

/// Period effect of a cross-over: each subject did A and B in one of two orders.
struct CrossOver {
    double effect = 0.0, low = 0.0, high = 0.0, p = 1.0;  ///< B − A, adjusted for the period
    double period = 0.0, period_p = 1.0;  ///< second period − first
    double freedom = 0.0;
};
/// `differences` are B − A, `b_second[i]` states that subject i did B second. Two-sample t with a common variance (Senn
/// 2002, chapter 3): effect and period are half sum and half difference of the means of the two groups. Throws Error unless
/// each order has a subject and there are three in all.
CrossOver cross_over(std::span<const double> differences, const std::vector<bool>& b_second, double confidence = 0.95);

/// Smallest standardised effect (mean over standard deviation of the differences) that a two-sided paired t test of n
/// subjects finds with probability `power`. Known before the data: power computed from the observed effect only repeats p.
double detectable_effect(std::size_t subjects, double power = 0.8, double alpha = 0.05);
/// Power of that test for a true standardised effect.
double power_of_test(std::size_t subjects, double effect, double alpha = 0.05);
/// Probability that equivalence_test() succeeds when the true difference is `effect`; margin and effect in known standard
/// deviations.
double power_of_equivalence(std::size_t subjects, double margin, double effect = 0.0, double alpha = 0.05);
/// The same of standardised_equivalence().
double power_of_standardised_equivalence(std::size_t subjects, double margin, double effect = 0.0, double alpha = 0.05);

}  // namespace tactus::statistics
