// SPDX-License-Identifier: Apache-2.0
// How fine the voxels of a bone must be for a kerf.
#pragma once

#include <cmath>

namespace tactus::carve {

/// A kerf must be three voxels wide; a little more is asked for, so that a rounded spacing is not refused.
inline constexpr double voxels_per_kerf = 3.05;

/// Coarsest voxel for `kerf`, both m; rounded down to 0.01 mm, so that it is what messages print.
inline double coarsest_voxel(double kerf) noexcept { return std::floor(1e5 * kerf / voxels_per_kerf + 1e-6) * 1e-5; }

}  // namespace tactus::carve
