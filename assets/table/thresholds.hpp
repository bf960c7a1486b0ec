// SPDX-License-Identifier: Apache-2.0
// Thresholds for two vibrations to count as equal.
#pragma once

#include <filesystem>
#include <optional>

namespace tactus::table {

/// Limits for the scores of a comparison. An empty limit is not judged, and neither is a score that does not exist.
struct Thresholds {
    // Upper limits. People notice level changes of about 2 dB.
    std::optional<double> lsd_db = 2.0;               ///< log-spectral distance, 40 to 500 Hz
    std::optional<double> harmonic_error_db = 2.0;    ///< worst order
    std::optional<double> third_octave_max_db = 4.5;  ///< worst band; a drifted actuator still passes
    std::optional<double> level_gap_db;               ///< level deficit of the output

    // Lower limits.
    std::optional<double> cosine_40_500 = 0.98, cosine_40_1000 = 0.95;
    std::optional<double> spectrogram_similarity, st_sim, spqi, coherence_mean;

    /// Lines in only one of the two count above this level, dB relative to the reference's strongest line.
    std::optional<double> added_line_db = -30.0, missing_line_db = -20.0;
};

/// Reads TOML: one key per member above; a number, or false for "not judged"; missing keys keep their default.
///
///     lsd_db = 1.5
///     st_sim = 0.95
///     added_line_db = false
///
/// Throws Error with file, line and column.
Thresholds load_thresholds(const std::filesystem::path& path);

}  // namespace tactus::table
