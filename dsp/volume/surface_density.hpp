// SPDX-License-Identifier: Apache-2.0
// The density of bone up to its surface.
#pragma once

#include "dsp/volume/grid.hpp"

namespace tactus::volume {

/// Sets samples outside of the bone, up to two voxels from its surface, to the mean density of their neighbours in the
/// bone (of the 26, then of those set before). Otherwise interpolation with air or soft tissue would lower the density
/// over the last voxel before the surface, so that bone in coarse voxels would be cut more easily. Both grids have the
/// same samples.
void extend_density(const Grid& distance, Grid& density);

}  // namespace tactus::volume
