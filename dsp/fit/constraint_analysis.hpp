// SPDX-License-Identifier: Apache-2.0
// Which motions a fit holds, from its stiffness.
#pragma once

#include "dsp/geometry/symmetric6.hpp"
#include "dsp/fit/fit.hpp"

namespace tactus::fit {

/// Fills `hold` and `free` of a fit. A turn counts as the way of a point `radius` from its axis (m), so that turns and
/// translations compare; the stiffness is divided by the weight that takes part, which leaves the mean square slope.
void find_free(Fit& fit, const geometry::Matrix6& stiffness, double radius, double least_hold);

}  // namespace tactus::fit
