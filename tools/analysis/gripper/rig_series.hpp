// SPDX-License-Identifier: Apache-2.0
// Measured series of a test rig as CSV, simulated or real.
#pragma once

#include "tools/analysis/gripper/rig_run.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tactus::analysis {

/// Columns: motor, object, stiffness_N_per_mm, damping_Ns_per_mm, rate_hz, amplitude_mm, time_s, force_N, position_mm
/// and, if known, slip and saturated (0 or 1). Consecutive lines with equal first six columns form a record. An object
/// called wall, or without stiffness and damping, is a rigid wall. Times must increase; uneven steps are resampled
/// linearly. `notes` receives remarks for the user. Throws Error with file and line.
std::vector<std::pair<RigCell, control::RigSeries>> load_rig_series(const std::filesystem::path& path,
                                                                    std::vector<std::string>& notes);

/// Returns one record in the format of such a file, with the header if it is the first.
std::string rig_series_csv(const RigCell& cell, const control::RigSeries& series, bool first);

}  // namespace tactus::analysis
