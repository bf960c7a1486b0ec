// SPDX-License-Identifier: Apache-2.0
// A measured frequency response as a filter.
#pragma once

#include "dsp/vibration/frequency_response.hpp"

#include <cstddef>
#include <vector>

namespace tactus::vibration {

/// Delay of a measured response as a filter beyond its own latency, s: two periods of its last frequency. Without it, a
/// response that ends there is not causal.
double plant_delay(const FrequencyResponse& response);

/// Impulse response of a measured response at `rate` (Hz), latency and `plant_delay` included: the inverse transform of its
/// interpolation, falling as f² below its first frequency, as an acceleration does, and to 0 within an octave above its last.
/// At most `length` taps. Throws Error if more than 1 % of its energy lies beyond them (it decays more slowly) or
/// before time 0 (its phase is not that of a causal system). Allocates.
std::vector<float> impulse_response(const FrequencyResponse& response, double rate, std::size_t length);

}  // namespace tactus::vibration
