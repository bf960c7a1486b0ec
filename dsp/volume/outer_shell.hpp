// SPDX-License-Identifier: Apache-2.0
// A bone as its outside shows it, without the hollows that a threshold leaves in it.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/volume/grid.hpp"

namespace tactus::volume {

/// Signed distance (m, negative inside) to the outside of {distance < 0}, on the same samples, which need to be distances
/// near the surface only: closed by a ball of
/// `radius` (m), hollows filled. What the outside reaches through openings of less than twice the radius, as marrow behind
/// thin cortex, is inside. Creases are rounded by as much. The lattice has to go on for more than the radius around the
/// bone; where it does not, the bone is open there.
Grid outer_shell(const Grid& distance, double radius, const RunJobs& run = run_in_turn);

}  // namespace tactus::volume
