// SPDX-License-Identifier: Apache-2.0
// What a guide must lose so that all of it can be printed.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/cutting_guide/guide_checks.hpp"
#include "dsp/cutting_guide/guide_solid.hpp"

#include <span>

namespace tactus::cutting_guide {

/// A body that, subtracted from `solid`, removes its walls that are thinner than `thickness`: near the middles of `thin`,
/// all that no ball of this diameter reaches within the solid (a morphological opening). Only there: elsewhere an
/// opening would round the edges, among them those of the slots. Planes cannot do the same: a wedge that they cut off
/// leaves another thin edge. `surface` is the mesh of the solid, `spacing` that of the grid for the opening.
Body thin_parts(const GuideSolid& solid, const geometry::TriangleTree& surface, std::span<const ThinWall> thin,
                double thickness, double spacing, const RunJobs& run);

}  // namespace tactus::cutting_guide
