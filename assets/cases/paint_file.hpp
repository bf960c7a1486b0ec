// SPDX-License-Identifier: Apache-2.0
// Paint on a surface as strokes of a brush, in a file that people can correct.
#pragma once

#include "dsp/contact/pointshell.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::cases {

/// Reads {"radius_mm": r, "paint": [[x, y, z], ...], "erase": [[x, y, z], ...]} and labels the points within the
/// radius of a stroke as fracture; those within it of an erasing stroke are none then. A stroke [x, y, z, r] has a radius
/// of its own. Labels that no stroke meets are taken off unless `keep`. Throws Error.
void paint_from_file(std::span<contact::SurfacePoint> points, const std::filesystem::path& path, bool keep = false);

/// The same of a file's text; `file` is its name in messages.
void paint_from_text(std::span<contact::SurfacePoint> points, std::string_view text, const std::string& file,
                     bool keep = false);

/// A painted face, for people: m.
struct PaintedFace {
    std::size_t points = 0;
    double area = 0.0;
    Vec3 middle{0.0}, normal{0.0};
};

/// Writes the paint of a surface as such a file, with the faces it falls into beside. Read back onto the same surface it
/// paints the same points. Throws Error.
std::vector<PaintedFace> write_paint_file(std::span<const contact::SurfacePoint> points, const std::string& bone,
                                          const std::filesystem::path& path);
std::vector<PaintedFace> painted_faces(std::span<const contact::SurfacePoint> points);

}  // namespace tactus::cases
