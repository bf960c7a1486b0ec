// SPDX-License-Identifier: Apache-2.0
// Paint on a surface as brush strokes, in a file that can be edited by hand.
#pragma once

#include "dsp/contact/pointshell.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::plan {

/// Reads {"radius_mm": r, "paint": [[x, y, z], ...], "erase": [[x, y, z], ...]}. Points within the radius of a paint
/// stroke become fracture, then points within the radius of an erase stroke are unlabelled. A stroke [x, y, z, r] has
/// its own radius. Other labels are removed unless `keep`. Throws Error.
void paint_from_file(std::span<contact::SurfacePoint> points, const std::filesystem::path& path, bool keep = false);

/// The same from the text of a file; `file` is its name in messages.
void paint_from_text(std::span<contact::SurfacePoint> points, std::string_view text, const std::string& file,
                     bool keep = false);

/// Summary of a painted face, m.
struct PaintedFace {
    std::size_t points = 0;
    double area = 0.0;
    Vec3 middle{0.0}, normal{0.0};
};

/// Writes the paint of a surface as such a file, with a summary of its faces. Reading it back onto the same surface
/// paints the same points. Throws Error.
std::vector<PaintedFace> write_paint_file(std::span<const contact::SurfacePoint> points, const std::string& bone,
                                          const std::filesystem::path& path);
std::vector<PaintedFace> painted_faces(std::span<const contact::SurfacePoint> points);

}  // namespace tactus::plan
