// SPDX-License-Identifier: Apache-2.0
// Iso-surface of a grid by marching tetrahedra.
#pragma once

#include "dsp/volume/grid.hpp"

#include <array>
#include <vector>

namespace tactus::geometry {

/// Triangles with shared vertices, counter-clockwise seen from outside.
struct TriangleSurface {
    std::vector<Vec3> vertices;                 ///< m
    std::vector<std::array<int, 3>> triangles;  ///< indices into vertices
};

/// The surface value == iso by marching tetrahedra (six per cell around its main diagonal), which has no ambiguous
/// case: closed and two-manifold except at the border of the grid. With `inside_above`, samples ≥ iso are inside;
/// otherwise samples < iso.
TriangleSurface iso_surface(const volume::Grid& grid, float iso, bool inside_above);

}  // namespace tactus::geometry
