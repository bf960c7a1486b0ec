// SPDX-License-Identifier: Apache-2.0
// Export of bones as volumes, for other programs.
#pragma once

#include "assets/bone/bone.hpp"

#include <span>

namespace tactus::bone {

/// The quantity in a volume.
enum class BoneQuantity {
    hu,  ///< HU from density, the inverse of the import, so that the import's threshold gives the same surface
    density,  ///< kg/m³ inside of the surface, 0 outside
    distance  ///< signed distance, mm, negative inside
};

/// HU at the surfaces in the volume of these bones: their import threshold, the lowest one if they have several, 300 HU
/// for bones from meshes and label maps.
double surface_hu(std::span<const Bone> bones);

/// One volume of all bones on a common lattice: at each sample the highest HU or density, or the smallest distance. Air
/// is -1000 HU; outside all grids the distance is 1000 mm. Throws Error if the grids of the bones have no common
/// lattice.
volume::Grid volume_of_bones(std::span<const Bone> bones, BoneQuantity quantity);

}  // namespace tactus::bone
