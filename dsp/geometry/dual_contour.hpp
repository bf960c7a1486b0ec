// SPDX-License-Identifier: Apache-2.0
// Surface of an implicit solid by dual contouring, with sharp edges.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/geometry/iso_surface.hpp"
#include "dsp/volume/grid.hpp"

#include <cstddef>

namespace tactus::geometry {

/// A solid as a function of position. Called by several threads at once.
class ImplicitSolid {
public:
    virtual ~ImplicitSolid() = default;
    /// m, negative inside. It changes by at most the distance between two positions (Lipschitz constant 1), so that
    /// whole blocks of samples can be classified by their middle.
    virtual double value(const Vec3& p) const noexcept = 0;
    /// Unit normal of the face that is active at `p`, out of the solid.
    virtual Vec3 normal(const Vec3& p) const noexcept = 0;
};

struct Contour {
    TriangleSurface surface;
    std::size_t crumbs = 0, voids = 0;  ///< separate parts below `crumb`, and enclosed cavities, that were removed
    double crumb_volume = 0.0;  ///< m³, of these parts, by their samples
    std::size_t flipped = 0;  ///< samples whose side was changed so that no edge has four triangles
    std::size_t smoothed = 0;  ///< vertices that gave up their edge so that no triangles intersect
};

/// Dual contouring (Ju, Losasso, Schaefer, Warren 2002): each cell of `layout` (its values are not read; cubic cells)
/// that the surface crosses gets the point that is nearest to the tangent planes at the crossings of its edges, so that
/// edges of the solid are edges of the mesh and flat faces are exact at any rotation; marching cubes chamfers edges by
/// up to 0.65 of a cell. Singular values below 0.1 of the largest are truncated; a vertex lies in its cell, or less
/// than half a cell beside it where an edge cuts off the cell's corner. A cell with several sheets gets a vertex for
/// each (CellSheets). Where two sheets still share an edge, the sample nearest to the surface changes its side;
/// vertices of triangles that intersect go back to the mean of their crossings. Separate parts of less than `crumb` m³
/// are removed, and enclosed cavities filled. The border of the layout counts as outside. The result does not depend on
/// how jobs are run.
Contour dual_contour(const volume::Grid& layout, const ImplicitSolid& solid, double crumb,
                     const RunJobs& run = run_in_turn);

}  // namespace tactus::geometry
