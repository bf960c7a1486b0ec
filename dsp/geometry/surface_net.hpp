// SPDX-License-Identifier: Apache-2.0
// The surface of a label: one vertex per cell between samples that are in and samples that are out.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <cstdint>
#include <vector>

namespace tactus::geometry {

/// A surface whose vertices each belong to one cell of a grid (eight samples).
struct SurfaceNet : TriangleSurface {
    std::vector<std::array<int, 3>> cell;  ///< per vertex: the cell's lowest sample
};

/// The net around the samples ≥ iso when `inside_above`, else around those < iso (Gibson 1998): every edge of the grid
/// that crosses the surface becomes a quad of the four cells around it, two triangles, counter-clockwise from outside;
/// vertices at the mean of their cell's crossings, one for each sheet that passes the cell. Samples that are in and touch
/// across the diagonal of a face only are parted (Nielson 2004, dual marching cubes). Closed when no sample of the border
/// is inside. Where sheets share a cell twice, an edge of the net can belong to four triangles.
SurfaceNet surface_net(const volume::Grid& grid, float iso, bool inside_above);

/// Takes the staircase off: `passes` times every vertex moves to the middle of its neighbours and back out a little
/// (Taubin 1995), at most 0.6 of a cell from where it began, so that a wall one sample thick stays a wall. The volume is
/// not kept.
void relax(SurfaceNet& net, const volume::Grid& grid, int passes, const RunJobs& run = run_in_turn);

}  // namespace tactus::geometry
