// SPDX-License-Identifier: Apache-2.0
// What two vibrations must reach to pass for the same.
#pragma once

#include <filesystem>
#include <optional>

namespace tactus::table {

/// Limits of the scores of a comparison. One that is empty is not judged, nor is one whose score does not exist.
struct Thresholds {
    // At most. People notice changes of level from about 2 dB on.
    std::optional<double> lsd_db = 2.0;               ///< log-spectral distance, 40 to 500 Hz
    std::optional<double> harmonic_error_db = 2.0;    ///< worst order
    std::optional<double> third_octave_max_db = 4.5;  ///< worst band; what a drifted actuator still reaches
    std::optional<double> level_gap_db;               ///< how much softer the output is

    // At least.
    std::optional<double> cosine_40_500 = 0.98, cosine_40_1000 = 0.95;
    std::optional<double> spectrogram_similarity, st_sim, spqi, coherence_mean;

    /// A line that only one of the two has counts from this level on, dB relative to the reference's strongest.
    std::optional<double> added_line_db = -30.0, missing_line_db = -20.0;
};

/// Reads TOML: one key per member above, a number, or false for "not judged"; what is not there keeps its default.
///
///     lsd_db = 1.5
///     st_sim = 0.95
///     added_line_db = false
///
/// Throws Error with file, line and column.
Thresholds load_thresholds(const std::filesystem::path& path);

}  // namespace tactus::table
