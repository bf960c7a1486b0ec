// SPDX-License-Identifier: Apache-2.0
// Distance from the samples of a grid to triangles.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <cstdint>
#include <vector>

namespace tactus::volume {

/// Distance (m) of every sample of `layout` (its size, origin and spacing; values are not read) from the surface. Exact
/// within one and a half of the widest cells. Farther away each sample starts from the triangles in the cell that holds
/// the nearest point of the surface, one point per cell, and then takes over what its neighbours know until nothing
/// becomes nearer by a ten-thousandth: within a tenth of a sample of brute force where tested. Infinite when no triangle
/// reaches the grid. Uses 24 bytes per sample. The result does not depend on how jobs are run.
std::vector<float> surface_distance(const Grid& layout, const geometry::TriangleSurface& surface,
                                    const RunJobs& run = run_in_turn);

/// Winding number of a closed surface at each sample, by signed crossings along x: 1 inside a surface whose triangles
/// are counter-clockwise from outside, 0 outside. Exact: samples on an edge or corner are decided by one consistent
/// infinitesimal shift.
std::vector<std::int16_t> winding_numbers(const Grid& layout, const geometry::TriangleSurface& surface,
                                          const RunJobs& run = run_in_turn);

/// Signed distance to a closed surface at the samples of `layout`, m, negative where the winding number is not 0.
Grid signed_distance(const Grid& layout, const geometry::TriangleSurface& surface, const RunJobs& run = run_in_turn);

}  // namespace tactus::volume
