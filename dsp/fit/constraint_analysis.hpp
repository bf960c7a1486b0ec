// SPDX-License-Identifier: Apache-2.0
// Constraint analysis: which motions a fit constrains, from the eigenvectors of its stiffness.
#pragma once

#include "dsp/fit/fit.hpp"
#include "dsp/geometry/symmetric6.hpp"

namespace tactus::fit {

/// Fills `hold` and `free` of a fit. A rotation counts as the displacement at `radius` from its axis (m), so that it is
/// comparable to translations. The stiffness is divided by the participating weight, which gives the mean square slope.
void find_free(Fit& fit, const geometry::Matrix6& stiffness, double radius, double min_hold);

}  // namespace tactus::fit
