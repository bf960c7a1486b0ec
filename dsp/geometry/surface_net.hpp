// SPDX-License-Identifier: Apache-2.0
// Surface nets (Gibson 1998): one vertex per cell between inside and outside samples.
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

/// Surface net (Gibson 1998) around the samples ≥ iso when `inside_above`, else around those < iso: every grid edge
/// that crosses the surface becomes a quad of the four cells around it, split in two triangles, counter-clockwise from
/// outside. A vertex is the mean of its cell's crossings, one per sheet in the cell. Inside samples that touch only
/// across the diagonal of a face are separated (dual marching cubes, Nielson 2004). The net is closed when no border
/// sample is inside. Where two sheets share two cells, an edge can belong to four triangles.
SurfaceNet surface_net(const volume::Grid& grid, float iso, bool inside_above);

/// Taubin smoothing (1995), which removes the staircase: `passes` times, each vertex moves to the mean of its
/// neighbours and partly back, at most 0.6 of a cell from its start, so that a wall one sample thick survives. The
/// volume is not preserved.
void relax(SurfaceNet& net, const volume::Grid& grid, int passes, const RunJobs& run = run_in_turn);

}  // namespace tactus::geometry
