// SPDX-License-Identifier: Apache-2.0
// A rate of repetition that is known roughly, made exact from the sound.
#pragma once

#include <span>

namespace tactus::vibration {

/// The rate within ±`range` (a ratio) of `rate` at which the lines of order 1 to `orders` of the Hann-windowed samples
/// together are strongest, exact to a small part of 1/duration for a steady sound: the phase of the whole record counts,
/// which the averaged spectrum that `fit_comb` reads has lost. Only sound below about 1.5 kHz counts. Returns `rate`
/// unchanged when the record is shorter than 8 periods. Allocates.
double refine_rate(std::span<const float> samples, double sample_rate, double rate, double range, int orders = 6);

}  // namespace tactus::vibration
