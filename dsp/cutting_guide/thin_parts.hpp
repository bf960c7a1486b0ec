// SPDX-License-Identifier: Apache-2.0
// What a guide must lose so that all of it can be printed.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/cutting_guide/guide_checks.hpp"
#include "dsp/cutting_guide/guide_solid.hpp"
#include "dsp/geometry/triangle_tree.hpp"

namespace tactus::cutting_guide {

/// A body that, subtracted from `solid`, removes its walls that are thinner than `limit`: near the middles of the thin
/// `walls`, all that stands out from the balls of this diameter within the solid (a morphological opening). Only there:
/// elsewhere an opening would round the edges, among them those of the slots. Planes cannot do the same: a wedge that
/// they cut off leaves another thin edge.
///
/// The balls are those that `walls` found at the triangles, not samples of a grid: in a wall just as thick as `limit`
/// balls fit at a single depth, which no sample hits. What stands out from the balls by up to three quarters of
/// wall_slack stays, as the triangles are a sample, too. `surface` is the mesh of the solid.
Body thin_parts(const GuideSolid& solid, const geometry::TriangleTree& surface, const Walls& walls, double limit,
                const RunJobs& run);

}  // namespace tactus::cutting_guide
