// SPDX-License-Identifier: Apache-2.0
// Intervals of a proportion.
#pragma once

#include <cstddef>
#include <utility>

namespace tactus::statistics {

/// Wilson's score interval (1927) of `successes` of `trials`; {0, 1} without trials. Unlike p ± z √(p (1 − p) / n), it has
/// a width where all or none succeed, and covers at small n (Brown, Cai and DasGupta 2001).
std::pair<double, double> wilson_interval(std::size_t successes, std::size_t trials, double confidence = 0.95);

}  // namespace tactus::statistics
