// SPDX-License-Identifier: Apache-2.0
// From a CT volume in HU to a bone.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/core/jobs.hpp"

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
/// HU from kg/m³ by the same line.
float hu_of_density(float density);
/// The same line in words, with its source.
std::string density_calibration();

struct HuBone {
    Bone bone;
    std::size_t components = 0;  ///< found above the threshold, before any were taken out
};

/// Builds distance and density on those samples of `hu` (LPS, m) that lie around the bone, with five millimetres and six
/// samples of room; outside of the volume four layers of air are added, so that a bone cut by its border ends in a flat
/// face half a voxel outside the last samples. Grey values are smoothed to about 0.3 mm (not at all where voxels are
/// coarser: any scanner blurs more than that). Throws Error when nothing reaches the threshold. Memory: four bytes per
/// sample of `hu`; then four (eight where it is smoothed) per sample of the box around all that reaches the threshold, or
/// of `hu` when that box is more than half of it, and eight per sample around the bone; then 16 per sample around the bone
/// and about 24 per cell that its surface crosses.
HuBone bone_from_hu(Grid hu, const BoneSurface& surface, const RunJobs& run = run_in_turn);

}  // namespace tactus
