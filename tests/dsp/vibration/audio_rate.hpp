// SPDX-License-Identifier: Apache-2.0
// What tests of vibrations share: the rate at which they run, Hz, and decibels of a ratio of amplitudes.
#pragma once

#include <cmath>

namespace tactus::test {

constexpr double audio_rate = 48000.0;

inline double decibel(double ratio) { return 20.0 * std::log10(ratio); }

}  // namespace tactus::test
