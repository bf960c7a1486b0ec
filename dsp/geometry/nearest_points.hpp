// SPDX-License-Identifier: Apache-2.0
// Nearest-point transform: the nearest of many points for each sample of a grid.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/volume/grid.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::geometry {

/// Index of the nearest point for each sample of `layout` (its values are not read); -1 everywhere without points.
/// `points` are in samples from the layout's origin; only the first of several points in one cell is used. Computes
/// lower envelopes of parabolas along x, y and z (Felzenszwalb and Huttenlocher 2012) with apices at the points'
/// positions: time and memory are linear in the number of samples. Within one row of cells the choice uses the distance
/// to the row's middle, so on a surface the result may lie a few samples beside the true nearest point; its distance is
/// too long by less than half a sample, and a local search finds the true one. The result does not depend on how jobs
/// are run. `layout` may be a slab of a larger volume that starts at layer `first`: points then count from the volume's
/// first layer, and the result equals that of the whole volume where a point is nearer than both ends of the slab.
std::vector<std::int32_t> nearest_points(const volume::Grid& layout, std::span<const glm::vec3> points,
                                         const RunJobs& run, int first = 0);

}  // namespace tactus::geometry
