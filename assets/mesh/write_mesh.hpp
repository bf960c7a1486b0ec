// SPDX-License-Identifier: Apache-2.0
// Meshes to files, in LPS and mm.
#pragma once

#include "dsp/geometry/iso_surface.hpp"

#include <filesystem>
#include <span>

namespace tactus::mesh {

/// A surface and the colour it is drawn in (sRGB, 0 to 1).
struct ColouredSurface {
    geometry::TriangleSurface surface;  ///< m, LPS
    Vec3 colour{0.90, 0.86, 0.76};
};

/// Writes all surfaces into one binary STL or PLY (by extension), coordinates in mm. The header says SPACE=LPS, which
/// 3D Slicer and others look for; PLY keeps shared vertices and colours. Throws Error for other extensions, when there is
/// no triangle, and when the file cannot be written; it appears whole or not at all.
void write_mesh(std::span<const ColouredSurface> surfaces, const std::filesystem::path& path);

/// The zero surface of a signed distance (m, negative inside) for use elsewhere: a net with vertices on the surface of the
/// cubic interpolant, or tetrahedra where the net would not be watertight.
geometry::TriangleSurface export_surface(const volume::Grid& distance);

}  // namespace tactus::mesh
