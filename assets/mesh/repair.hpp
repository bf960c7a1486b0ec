// SPDX-License-Identifier: Apache-2.0
// Meshes that are not quite closed become surfaces with an inside.
#pragma once

#include "dsp/geometry/iso_surface.hpp"

#include <cstddef>
#include <string>

namespace tactus::mesh {

/// What repair() found and did.
struct MeshRepair {
    std::size_t duplicates = 0;          ///< triangles on the same three points, taken out
    std::size_t turned = 0;              ///< triangles turned about, so that neighbours look to the same side
    std::size_t boundary_edges = 0;      ///< around holes
    std::size_t holes = 0;               ///< closed, each with a fan around its middle
    double hole_share = 0.0;             ///< area of the fans over the area of the mesh
    std::size_t non_manifold_edges = 0;  ///< with more than two triangles; they stay, for they leave an inside defined

    bool is_clean() const { return duplicates + turned + boundary_edges + non_manifold_edges == 0; }
    /// "closed 3 holes (23 boundary edges, 0.4 % of the surface); ..."; empty when clean.
    std::string describe() const;
};

/// Makes every edge be passed as often forwards as backwards, which is what winding numbers need. Throws Error with
/// the numbers when the surface has but one side, or when closing its holes would add more than 5 % to its area.
MeshRepair repair(geometry::TriangleSurface& mesh, const std::string& file);

}  // namespace tactus::mesh
