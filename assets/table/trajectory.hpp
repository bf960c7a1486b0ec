// SPDX-License-Identifier: Apache-2.0
// Recorded movements of a hand-held device or tool, as CSV.
#pragma once

#include "dsp/simulate/trajectory.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::table {

/// A recording: samples in s, m and unit quaternions, in the frame it was recorded in.
struct Trajectory {
    std::vector<simulate::TrajectorySample> samples;
    std::vector<std::size_t> breaks;  ///< samples that begin a new trial or follow a lost one
    std::vector<Vec3> forces;         ///< N, as recorded; empty when the file has none
    std::size_t lost = 0;             ///< rows whose status is not OK; left out
    double median_step_s = 0.0;

    /// Rules for playing: a gap is longer than 50 ms and than one and a half usual steps, so that the slow stream of a
    /// tracker is not all gaps.
    simulate::TrajectoryRules rules() const;
};

/// What to take from a file.
struct TrajectorySelection {
    std::string tool;  ///< prefix of the columns ("Stylus" for "Stylus_px_mm"); "" when they have none
    int trial = 0;  ///< number in the column "trial"; 0 takes all of them
};

/// Reads a CSV file with a header line. Columns are found by name, units are part of the names: t_s or t_ms; px, py, pz
/// with _mm, _cm or _m; qx, qy, qz, qw; optional trial, fx_N, fy_N, fz_N, and status, where all but "OK" means a
/// sample that was lost. Other columns are ignored. Throws Error with file:line:column for a missing column, text that
/// is no finite number, a quaternion that is no rotation, times that do not increase; also for a file with nothing to
/// play.
Trajectory read_trajectory(const std::filesystem::path& path, const TrajectorySelection& selection = {});

}  // namespace tactus::table
