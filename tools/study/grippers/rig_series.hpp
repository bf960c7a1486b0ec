// SPDX-License-Identifier: Apache-2.0
// What a rig measured, as CSV: written by a simulated one, read from any.
#pragma once

#include "tools/study/grippers/rig_run.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tactus::study {

/// Columns: motor, object, stiffness_N_per_mm, damping_Ns_per_mm, rate_hz, amplitude_mm, time_s, force_N, position_mm and,
/// if known, slip and saturated (0 or 1). Neighbouring lines with equal first six columns are one record. An object
/// called wall, or without stiffness and damping, is a rigid wall. Times rise; uneven ones are evened out by straight
/// lines. `notes` gets what the reader should know. Throws Error with file and line.
std::vector<std::pair<RigCell, control::RigSeries>> load_rig_series(const std::filesystem::path& path,
                                                                    std::vector<std::string>& notes);

/// One record of such a file, with the line of names when it is the first.
std::string rig_series_csv(const RigCell& cell, const control::RigSeries& series, bool first);

}  // namespace tactus::study
