// SPDX-License-Identifier: Apache-2.0
// Distance from the samples of a grid to triangles, and winding numbers.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <cstdint>
#include <vector>

namespace tactus::volume {

/// Distance (m) of every sample of `layout` (its size, origin and spacing; values are not read) from the surface. Exact
/// within 1.5 of the widest cells. Farther away each sample starts from the triangles in the cell with the nearest
/// surface point, one point per cell, and then takes over nearer triangles from its neighbours until no distance
/// decreases by more than a ten-thousandth. If the edges of triangles are longer than two samples on average, this is
/// done for every second sample, and those between try the triangles of the ones around them. Within a tenth of a sample
/// of brute force where tested. Infinite when no triangle reaches the grid. Uses 24 bytes per sample, 7 with large
/// triangles. The result does not depend on how jobs are run.
std::vector<float> surface_distance(const Grid& layout, const geometry::TriangleSurface& surface,
                                    const RunJobs& run = run_in_turn);

/// Winding number of a closed surface at each sample, by signed crossings along x: 1 inside a surface with
/// counter-clockwise triangles (seen from outside), 0 outside. Exact: a consistent infinitesimal shift decides samples
/// on an edge or corner.
std::vector<std::int16_t> winding_numbers(const Grid& layout, const geometry::TriangleSurface& surface,
                                          const RunJobs& run = run_in_turn);

/// Signed distance to a closed surface at the samples of `layout`, m, negative where the winding number is not 0.
Grid signed_distance(const Grid& layout, const geometry::TriangleSurface& surface, const RunJobs& run = run_in_turn);

/// The same near the surface only: exact within `reach` (m), and `reach` with its sign beyond. Faster where the rest is
/// not needed, and uses 6 bytes per sample.
Grid signed_distance_near(const Grid& layout, const geometry::TriangleSurface& surface, double reach,
                          const RunJobs& run = run_in_turn);

}  // namespace tactus::volume
