// SPDX-License-Identifier: Apache-2.0
// The rate at which something repeats, heard in a recording of it.
#pragma once

#include <span>

namespace tactus {

struct Fundamental {
    double rate = 0.0;         ///< Hz; 0 when nothing repeats
    double periodicity = 0.0;  ///< normalised autocorrelation at that period: 1 a periodic sound, near 0 noise
};

/// Rate of repetition between `lowest` and `highest` (Hz): the shortest period whose normalised autocorrelation comes
/// near the best (McLeod and Wyvill 2005), made precise by `refine_rate`. Only sound below about 1.5 kHz counts. A
/// motion and its subharmonic are told apart by that rule only; a rate that is known should be stated instead.
/// Allocates.
Fundamental estimate_fundamental(std::span<const float> samples, double sample_rate, double lowest = 60.0,
                                 double highest = 400.0);

/// The rate within ±`range` (a ratio) of `rate` at which the lines of order 1 to `orders` of the Hann-windowed samples
/// together are strongest, exact to a small part of 1/duration for a steady sound. Returns `rate` unchanged when the
/// record is shorter than 8 periods. Allocates.
double refine_rate(std::span<const float> samples, double sample_rate, double rate, double range, int orders = 6);

}  // namespace tactus
