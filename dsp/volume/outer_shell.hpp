// SPDX-License-Identifier: Apache-2.0
// The outer surface of a bone, without the hollows left by a threshold.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/volume/grid.hpp"

namespace tactus::volume {

/// Signed distance (m, negative inside) to the outside of {distance < 0} on the same samples: a morphological closing
/// by a ball of `radius` (m), with hollows filled. The input needs to be a distance near the surface only. Regions that
/// open to the outside by less than twice the radius, such as marrow behind thin cortex, are inside. Concave edges are
/// rounded by the radius. The grid must extend beyond the bone by more than the radius; where it does not, the bone is
/// open there.
Grid outer_shell(const Grid& distance, double radius, const RunJobs& run = run_in_turn);

}  // namespace tactus::volume
