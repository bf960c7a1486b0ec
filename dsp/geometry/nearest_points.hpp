// SPDX-License-Identifier: Apache-2.0
// Which of many points is nearest to each sample of a grid.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/volume/grid.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::geometry {

/// Index of the nearest point per sample of `layout` (its values are not read), -1 everywhere without points. `points`
/// are in samples from the layout's origin; of several in one cell of the grid only the first takes part. Lower envelopes
/// of parabolas along x, y and z (Felzenszwalb and Huttenlocher 2012) with apices at the points' own places: time and
/// memory are proportional to the samples. Within one row of cells the choice is by the distance to the row's middle,
/// so on a surface the point found may lie a few samples beside the nearest one; its distance is then too long by less
/// than half a sample, and looking around it finds the nearest. The result does not depend on how jobs are run.
/// `layout` may be some layers of a larger volume, from `first` on: points then count from the whole volume's first
/// layer, and samples nearer to one of them than to either end of the layers know what the whole volume's would.
std::vector<std::int32_t> nearest_points(const volume::Grid& layout, std::span<const glm::vec3> points, const RunJobs& run,
                                         int first = 0);

}  // namespace tactus::geometry
