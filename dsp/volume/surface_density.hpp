// SPDX-License-Identifier: Apache-2.0
// The density of bone up to its surface.
#pragma once

#include "dsp/volume/grid.hpp"

namespace tactus::volume {

/// Gives samples outside of the bone, up to two voxels from its surface, the mean density of their neighbours in the bone
/// (26, then of those). Interpolated with what is outside, air or soft tissue, the density would fall to it over the last
/// voxel before the surface, so that bone in coarse voxels would be cut more easily. Both grids have the same samples.
void extend_density(const Grid& distance, Grid& density);

}  // namespace tactus::volume
