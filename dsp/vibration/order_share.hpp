// SPDX-License-Identifier: Apache-2.0
// How much of a recording belongs to a machine that strokes at a given rate.
#pragma once

#include <span>

namespace tactus::vibration {

/// Fraction of the power above half of `rate` that stands out of the noise around multiples 1 to 8 of `rate`: 1 for a
/// periodic vibration at that rate, near 0 for noise, or for a machine with another rate. A multiple is everything within
/// 2 % of `rate` times the multiple, so that a rate which wanders by that much still counts; the noise is the median
/// between two multiples. Allocates. 0 for fewer than 16 periods.
double order_share(std::span<const float> samples, double sample_rate, double rate);

}  // namespace tactus::vibration
