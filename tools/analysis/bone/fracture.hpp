// SPDX-License-Identifier: Apache-2.0
// Breaks a bone: simulated, displaced fragments with ground truth.
#pragma once

#include "assets/bone/bone.hpp"

#include <cstdint>
#include <functional>

namespace tactus::analysis {

struct FractureSettings {
    int pieces = 2, missing = 0;             ///< missing: number of the smallest fragments to omit
    std::uint64_t seed = 1;
    double chips = 0.0;                      ///< fraction of the area
    double kerf = 0.0, roughness = 0.8e-3;   ///< m
    double voxel = 0.35e-3, blur = 0.25e-3;  ///< m, voxel size and blur of the scan
    double noise = 0.03;                     ///< fraction of the contrast
    double spread = 10e-3;                   ///< m, displacement of the fragments
    double turn = 0.35;                      ///< rad, rotation of the fragments
    double spacing = 0.42e-3;                ///< m, spacing of the surface points
};

struct ScannedFragment {
    bone::Bone bone;            ///< without a name
    Pose place;           ///< p_bone = R p_fragment + t
    double volume = 0.0;  ///< m³, before the scan
};

/// Calls back with the fragments one by one; the first is the largest and is not moved. Throws Error.
void break_and_scan(const bone::Bone& bone, const FractureSettings& settings,
                    const std::function<void(ScannedFragment fragment)>& take);

}  // namespace tactus::analysis
