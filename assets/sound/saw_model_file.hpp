// SPDX-License-Identifier: Apache-2.0
// Files of saw models: written by 'tactus model', played by the 'saw' node.
#pragma once

#include "assets/file/toml_file.hpp"
#include "dsp/vibration/saw_model.hpp"

#include <filesystem>
#include <string>

namespace tactus::sound {

struct SawModelTexts {
    std::string title, note, licence;
    bool synthesised = false;  ///< fitted to computed sounds, not to recordings
    bool calibrated = false;   ///< levels are in m/s², otherwise normalised
};

/// Writes the whole file:
///
///     title = "…"   note = "…"   licence = "…"   synthesised = true
///     [model]
///     version = 1
///     unit = "m/s^2"                   # or "normalised": uncalibrated, the strongest recording as 100 m/s^2 rms
///     phases = [0.0, …]                # rad, of each order
///     [[model.condition]]
///     rate = "150 Hz"   state = "cutting"   load = "7 N"   density = "1200 kg/m^3"
///     orders = [12.3, …]               # rms of order 1, 2, …
///     residual = 8.9                   # rms
///     lines = [0.1, …]                 # 24 line spectral frequencies, rad per sample at 8 kHz
///     swell = [c1, s1, c2, s2, …]      # power of the residual over the stroke
///
/// Throws Error.
void save_saw_model(const vibration::SawModel& model, const SawModelTexts& texts, const std::filesystem::path& path);

struct SawModelTable {
    vibration::SawModel model;
    bool calibrated = false;
};

/// Reads the table [model]. `file` names it in messages. Throws Error with file, line and column.
SawModelTable read_saw_model(const toml::table& table, const std::string& file);

}  // namespace tactus::sound
