// SPDX-License-Identifier: Apache-2.0
// Writes meshes to files, in LPS and mm.
#pragma once

#include "dsp/geometry/iso_surface.hpp"

#include <filesystem>
#include <span>

namespace tactus::mesh {

/// A surface and its colour (sRGB, 0 to 1).
struct ColouredSurface {
    geometry::TriangleSurface surface;  ///< m, LPS
    Vec3 colour{0.90, 0.86, 0.76};
};

/// Writes all surfaces into one binary STL, PLY or 3MF (by extension), coordinates in mm. The header states SPACE=LPS,
/// which 3D Slicer and others read; PLY and 3MF keep shared vertices and colours, 3MF the unit and separate objects. Written atomically. Throws Error for other
/// extensions, for no triangles, and when the file cannot be written.
void write_mesh(std::span<const ColouredSurface> surfaces, const std::filesystem::path& path);

/// The zero surface of a signed distance (m, negative inside) for other programs: a surface net with vertices on the
/// cubic interpolant, or marching tetrahedra if the net is not watertight.
geometry::TriangleSurface export_surface(const volume::Grid& distance);

}  // namespace tactus::mesh
