// SPDX-License-Identifier: Apache-2.0
// Recorded movements of a device or tool, as CSV.
#pragma once

#include "dsp/simulate/trajectory.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::table {

/// A recording: samples in s, m and unit quaternions, in the frame it was recorded in.
struct Trajectory {
    std::vector<simulate::TrajectorySample> samples;
    std::vector<std::size_t> breaks;  ///< samples that begin a new trial
    std::vector<Vec3> forces;         ///< N, as recorded; empty when the file has none
    std::size_t lost = 0;             ///< rows with a status other than OK; skipped
    double median_step_s = 0.0;

    /// Playback settings. A gap is longer than 50 ms and longer than 1.5 typical steps, so that a slow tracker does not
    /// consist of gaps only.
    simulate::TrajectoryRules rules() const;
};

/// Selects a part of a file.
struct TrajectorySelection {
    std::string tool;  ///< prefix of the columns ("Stylus" for "Stylus_px_mm"); "" for none
    int trial = 0;  ///< number in the column "trial"; 0: all trials
};

/// Reads a CSV file with a header line. Columns are found by name, units are part of the names: t_s or t_ms; px, py, pz
/// with _mm, _cm or _m; qx, qy, qz, qw; optional trial, fx_N, fy_N, fz_N, and status, where any value but "OK" marks a
/// lost sample. Other columns are ignored. Throws Error with file:line:column for a missing column, text that is not a
/// finite number, a quaternion that is not a rotation, and times that do not increase; also for a file without samples.
Trajectory read_trajectory(const std::filesystem::path& path, const TrajectorySelection& selection = {});

}  // namespace tactus::table
