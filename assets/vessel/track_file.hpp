// SPDX-License-Identifier: Apache-2.0
// Writes tracked vessels for other programs. Positions in LPS and mm.
#pragma once

#include "dsp/vessel/track.hpp"

#include <filesystem>
#include <span>
#include <string>

namespace tactus::vessel {

/// The format depends on the extension:
///
/// - .csv: a row per node: branch, x_mm, y_mm, z_mm, radius_mm, contrast, confidence, parent. `parent` is the row of the
/// node before this one, counted from 0; -1 for the first node of all. The first node of a side branch repeats the
/// position on its parent's axis.
/// - .vtp: VTK PolyData, a line per branch, with arrays of the same names (ASCII); field data `warnings`, a string each.
/// - .mrk.json: 3D Slicer markups, an open curve per branch, with the radius of each control point in its description;
///   a warning is in the description of its control point, warnings about the whole vessel in that of the first.
/// - .stl, .ply: a closed tube per branch; PLY has a colour per branch.
///
/// `warnings`: about the whole vessel, in addition to warnings_of(track). CSV, STL and PLY cannot store warnings.
/// Written atomically. Throws Error for other extensions, for a track without branches, and when the file cannot be
/// written.
void write_track(const Track& track, const std::filesystem::path& path, std::span<const std::string> warnings = {});

/// True for the extensions that write_track supports.
bool is_track_file(const std::filesystem::path& path);

}  // namespace tactus::vessel
