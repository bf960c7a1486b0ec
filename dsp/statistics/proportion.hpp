// SPDX-License-Identifier: Apache-2.0
// Intervals of a proportion.
#pragma once

#include <cstddef>
#include <utility>

namespace tactus::statistics {

/// Wilson's score interval (1927) of `successes` of `trials`; {0, 1} without trials. Unlike p ± z √(p (1 − p) / n), it has
/// a width where all or none succeed, and covers at small n (Brown, Cai and DasGupta 2001).
std::pair<double, double> wilson_interval(std::size_t successes, std::size_t trials, double confidence = 0.95);

/// Numbers of pairs of trials by outcome.
struct PairedOutcomes {
    std::size_t both = 0, first_only = 0, second_only = 0, neither = 0;
};

/// Interval of the difference of two proportions of the same pairs, the first minus the second: Newcombe's method 10
/// (Statistics in Medicine 17:2635, 1998), Wilson's intervals combined with the correlation of the pairs. Unlike a t
/// interval of the differences, it has a width where no pair differs. {-1, 1} without pairs.
std::pair<double, double> paired_difference_interval(const PairedOutcomes& pairs, double confidence = 0.95);

}  // namespace tactus::statistics
