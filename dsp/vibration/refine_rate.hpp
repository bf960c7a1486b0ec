// SPDX-License-Identifier: Apache-2.0
// Refines an approximate repetition rate from the sound.
#pragma once

#include <span>

namespace tactus::vibration {

/// The rate within ±`range` (a ratio) of `rate` that maximises the summed power of orders 1 to `orders` of the
/// Hann-windowed samples; for a steady sound exact to a small fraction of 1/duration: it uses the phase of the whole
/// record, which the averaged spectra of `find_fundamental` do not have. Uses content below about 1.5 kHz. Returns `rate`
/// unchanged when the record is shorter than 8 periods. Allocates.
double refine_rate(std::span<const float> samples, double sample_rate, double rate, double range, int orders = 6);

}  // namespace tactus::vibration
