// SPDX-License-Identifier: Apache-2.0
// Bones as volumes for other programs.
#pragma once

#include "assets/bone/bone.hpp"

#include <span>

namespace tactus::bone {

/// What a volume holds.
enum class BoneQuantity {
    hu,  ///< HU from density by the line of the import, so that the threshold of the import gives the surface again
    density,  ///< kg/m³ inside of the surface, 0 outside
    distance  ///< signed distance, mm, negative inside
};

/// One volume of all bones on their common samples: the highest HU or density, the least distance. Air is -1000 HU; away
/// from all grids the distance is 1000 mm. Throws Error when the bones' samples do not lie on one lattice.
volume::Grid volume_of_bones(std::span<const Bone> bones, BoneQuantity quantity);

}  // namespace tactus::bone
