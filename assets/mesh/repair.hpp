// SPDX-License-Identifier: Apache-2.0
// Repairs meshes with small defects, so that their inside is defined.
#pragma once

#include "dsp/geometry/iso_surface.hpp"

#include <cstddef>
#include <string>

namespace tactus::mesh {

/// Report of repair().
struct MeshRepair {
    std::size_t duplicates = 0;          ///< triangles on the same three points, removed
    std::size_t turned = 0;              ///< triangles flipped to match their neighbours
    std::size_t boundary_edges = 0;      ///< at the borders of holes
    std::size_t holes = 0;               ///< closed, each with a fan around its centre
    double hole_share = 0.0;             ///< area of the fans over the area of the mesh
    std::size_t non_manifold_edges = 0;  ///< with more than two triangles; kept, because the inside stays defined

    bool is_clean() const { return duplicates + turned + boundary_edges + non_manifold_edges == 0; }
    /// "closed 3 holes (23 boundary edges, 0.4 % of the surface); ..."; empty when clean.
    std::string describe() const;
};

/// Makes every edge traversed equally often in both directions, as winding numbers need. Throws Error with the numbers
/// if the surface is not orientable, or if closing its holes would add more than 5 % to its area.
MeshRepair repair(geometry::TriangleSurface& mesh, const std::string& file);

}  // namespace tactus::mesh
