// SPDX-License-Identifier: Apache-2.0
// A plain ridge tracker, the peer of `tactus bench vessel`.
#pragma once

#include "dsp/volume/grid.hpp"

#include <vector>

namespace tactus::bench {

/// Follows the ridge of brightness through `seed` both ways at one scale (m): eigenvectors of the Hessian of the scan
/// under a normal filter; steps of a fifth of a sample along the third, corrected towards the ridge; until the two
/// cross-section curvatures are no longer alike (ratio below 0.15), fall below 0.3 of those at the seed, the direction turns
/// by more than 60 degrees, or the scan ends. After Aylward and Bullitt (IEEE TMI 2002), without their recovery.
/// Points in order, m.
std::vector<Vec3> follow_ridge(const volume::Grid& grid, const Vec3& seed, double scale);

}  // namespace tactus::bench
