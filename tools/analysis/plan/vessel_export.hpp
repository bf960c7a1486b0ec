// SPDX-License-Identifier: Apache-2.0
// Writes the vessels of a plan for other programs.
#pragma once

#include "dsp/core/types.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tactus::analysis {

/// Writes a line of `points` (m) and one radius (m), LPS, mm, once for each of `types`: .stl or .ply, a closed tube;
/// .vtp, a line with its radius; .mrk.json, a curve of 3D Slicer. Files are named after the vessel and added to
/// `taken`; a name that is already in it gets a number. A line of zero length is not written. Throws Error.
void export_vessel(const std::string& name, std::span<const Vec3> points, double radius,
                   const std::vector<std::string>& types, const std::filesystem::path& out,
                   std::vector<std::string>& taken);

}  // namespace tactus::analysis
