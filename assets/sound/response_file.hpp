// SPDX-License-Identifier: Apache-2.0
// Files of measured frequency responses.
#pragma once

#include "dsp/vibration/identify.hpp"

#include <filesystem>
#include <string>

namespace tactus::sound {

struct ResponseFile {
    std::string title;  ///< the measured path
    std::string unit;   ///< of the gain, "m/s^2 per V"; empty when unknown
    vibration::Identified identified;
};

/// Writes CSV:
///
///     # title = "saw-vibration: actuator.drive to actuator.signal"
///     # unit = "m/s^2 per V"
///     # latency_s = 0.0026667          (removed from the phase)
///     frequency_hz,level_db,phase_deg,coherence,order_2,order_3,…
///     22.5,-14.21,171.3,0.99998,0.00021,0.00004,…
///
/// level_db is 20 log10 of the gain; order_n is the amplitude at n × frequency relative to the fundamental, empty
/// beyond the sweep. Throws Error.
void save_response(const ResponseFile& file, const std::filesystem::path& path);

/// Reads files of `save_response`, and tables of other programs: columns separated by commas, semicolons, blanks or
/// tabs; frequency in Hz, level in dB and optionally phase in degrees, in this order unless a header line names the
/// columns; lines that begin with #, * or ; are comments. Without phase, minimum phase is assumed. At most 1 000 000
/// lines. Throws Error with the line.
ResponseFile load_response(const std::filesystem::path& path);

}  // namespace tactus::sound
