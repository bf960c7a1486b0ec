// SPDX-License-Identifier: Apache-2.0
// Measured frequency responses on disk.
#pragma once

#include "dsp/vibration/identify.hpp"

#include <filesystem>
#include <string>

namespace tactus::sound {

struct ResponseFile {
    std::string title;  ///< what was measured
    std::string unit;   ///< of the gain, "m/s^2 per V"; empty when unknown
    vibration::Identified identified;
};

/// Writes CSV:
///
///     # title = "saw-vibration: actuator.drive to actuator.signal"
///     # unit = "m/s^2 per V"
///     # latency_s = 0.0026667          (taken out of the phase)
///     frequency_hz,level_db,phase_deg,coherence,order_2,order_3,…
///     22.5,-14.21,171.3,0.99998,0.00021,0.00004,…
///
/// level_db is 20 log10 of the gain; order_n the amplitude at n × frequency over that at the frequency, empty where the
/// sweep did not reach. Throws Error.
void save_response(const ResponseFile& file, const std::filesystem::path& path);

/// Reads what `save_response` writes, and tables of other programs: columns separated by commas, semicolons, blanks or
/// tabs; frequency in Hz, level in dB and, optionally, phase in degrees, in that order unless a line of names says
/// otherwise; lines that begin with #, * or ; are remarks. Without phases the system is taken to be of minimum phase.
/// At most 1 000 000 lines. Throws Error with the line.
ResponseFile load_response(const std::filesystem::path& path);

}  // namespace tactus::sound
