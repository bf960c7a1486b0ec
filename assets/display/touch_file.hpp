// SPDX-License-Identifier: Apache-2.0
// The touches that a display rig is calibrated from, as CSV.
#pragma once

#include "dsp/display/rig_touches.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tactus::display {

/// Columns of, x_mm, y_mm, z_mm (where the tip was, frame of the device), and where they mean something screen, u, v
/// (the mark) and at_x_mm, at_y_mm, at_z_mm (the same place in the world of the viewer). `of` is workspace, screen, image
/// or mirror. Throws Error with file:line.
std::vector<RigTouch> load_touches(const std::filesystem::path& path);

/// What load_touches reads back to the nanometre.
std::string touches_text(std::span<const RigTouch> touches);

/// Places with the columns x_mm, y_mm, z_mm, in m. Throws Error.
std::vector<Vec3> load_places(const std::filesystem::path& path);

}  // namespace tactus::display
