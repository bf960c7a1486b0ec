// SPDX-License-Identifier: Apache-2.0
// Breaks a bone: fragments as a scan shows them, displaced, and where they belong.
#pragma once

#include "assets/bone/bone.hpp"

#include <cstdint>
#include <functional>

namespace tactus::study {

struct FractureSettings {
    int pieces = 2, missing = 0;             ///< so many of the smallest are lost
    std::uint64_t seed = 1;
    double chips = 0.0;                      ///< share of the area
    double kerf = 0.0, roughness = 0.8e-3;   ///< m
    double voxel = 0.35e-3, blur = 0.25e-3;  ///< m, of the scan
    double noise = 0.03;                     ///< share of the contrast
    double spread = 10e-3;                   ///< m, how far the fragments lie from their places
    double turn = 0.35;                      ///< rad, how far they are turned
    double spacing = 0.42e-3;                ///< m, of the surface points
};

struct ScannedFragment {
    bone::Bone bone;            ///< without a name
    Pose place;           ///< p_bone = R p_fragment + t
    double volume = 0.0;  ///< m³, before it was scanned
};

/// Hands over the fragments one by one, the largest first, which has not moved. Throws Error.
void break_and_scan(const bone::Bone& bone, const FractureSettings& settings,
                    const std::function<void(ScannedFragment fragment)>& take);

}  // namespace tactus::study
