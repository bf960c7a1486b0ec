// SPDX-License-Identifier: Apache-2.0
// Touches for the calibration of a display, as CSV.
#pragma once

#include "dsp/display/display_fit.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tactus::display {

/// Columns: of (workspace, screen, image or mirror), x_mm, y_mm, z_mm (position of the tip in the frame of the device);
/// for marks also screen, u, v; for workspace touches also at_x_mm, at_y_mm, at_z_mm (the same position in the viewer's
/// world). Throws Error with file:line.
std::vector<Touch> load_touches(const std::filesystem::path& path);

/// The text of such a file; load_touches reads it back within a nanometre.
std::string touches_text(std::span<const Touch> touches);

/// Reads positions from the columns x_mm, y_mm, z_mm; m. Throws Error.
std::vector<Vec3> load_places(const std::filesystem::path& path);

}  // namespace tactus::display
