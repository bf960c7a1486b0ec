// SPDX-License-Identifier: Apache-2.0
// From a CT volume in HU to a bone.
#pragma once

#include "assets/bone/bone.hpp"

#include <cstddef>
#include <string>

namespace tactus {

/// How the surface of a bone is taken from CT values.
struct BoneSurface {
    float threshold = 300.0f;  ///< HU; bone is what lies at or above
    std::size_t keep = 1;      ///< how many components, largest first; 0 keeps all
    bool fill = true;          ///< hollows that do not reach the outside count as bone (their density stays low)
};

/// kg/m³ from HU by the default line, never below 0. Uncalibrated: no density phantom was in the scan.
float density_of_hu(float hu);
/// The same line in words, with its source.
std::string density_calibration();

struct HuBone {
    Bone bone;
    std::size_t components = 0;  ///< found above the threshold, before any were taken out
};

/// Builds distance and density on the samples of `hu` (LPS, m) with four more layers of air around it, so that a bone
/// cut by the border ends in a flat face half a voxel outside its last samples. Grey values are smoothed to about
/// 0.35 mm (not at all where voxels are coarser). Throws Error when nothing reaches the threshold.
HuBone bone_from_hu(const Grid& hu, const BoneSurface& surface);

}  // namespace tactus
