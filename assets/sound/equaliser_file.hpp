// SPDX-License-Identifier: Apache-2.0
// Equaliser files.
#pragma once

#include "dsp/vibration/equaliser.hpp"

#include <filesystem>

namespace tactus::sound {

/// Writes an equaliser as TOML:
///
///     title     = "equaliser of saw-vibration: actuator.drive to actuator.signal"
///     kind      = "minimum_phase"      # or "linear_phase"
///     rate      = "48000 Hz"
///     delay     = "0.00025 s"          # of the filter
///     band      = ["45 Hz", "1000 Hz"] # in which actuator and equaliser together are flat
///     mean_gain = 12.3                 # of actuator and equaliser together
///     unit      = "m/s^2 per V"            # of mean_gain
///     taps      = [ … ]                # the impulse response at that rate
///
/// Throws Error.
void save_equaliser(const vibration::Equaliser& equaliser, const std::string& title, const std::filesystem::path& path);

/// Reads a file of `save_equaliser`; rate and taps are required. At most 2 s and 1 000 000 taps. Throws Error.
vibration::Equaliser load_equaliser(const std::filesystem::path& path);

}  // namespace tactus::sound
