// SPDX-License-Identifier: Apache-2.0
// Fractures with ground truth, and start poses with errors.
#pragma once

#include "dsp/fit/fit_surface.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::bench {

/// Properties of a simulated fracture.
struct FractureKind {
    const char* name;
    double roughness;  ///< m
    double chips;      ///< share of the area
    double spill;      ///< m, paint beyond the fracture's rim
    double noise;      ///< noise of the scan, share of the contrast
};

/// Error of the start pose.
struct FractureStart {
    double offset_mm, angle_deg;
};

struct FractureCase {
    FractureKind kind;
    std::vector<FractureStart> starts;
};

/// All cases, by name.
const std::vector<FractureCase>& fracture_cases();

struct FracturePair {
    std::vector<contact::SurfacePoint> moving_points;  ///< of the whole moving piece, in its file's frame
    fit::FitSurface moving, fixed;
    Pose truth;  ///< of the moving piece in the fixed one's frame

    /// Target registration error: rms distance between a pose and the truth over the moving piece's surface, m.
    double error(const Pose& pose) const;
};

/// Breaks `bone` in two, scans each half with its own rotation, and paints the surface that did not exist before.
FracturePair make_fracture_pair(const volume::Grid& bone, const FractureKind& kind, std::uint64_t seed);

/// The truth, translated by `offset` (m) and rotated by `angle` (rad) about the centre of the moving paint in random
/// directions; if `pushed`, then moved along the fracture's normal until the painted surfaces do not overlap.
Pose start_beside(const FracturePair& pair, double offset, double angle, bool pushed, std::uint64_t seed);

}  // namespace tactus::bench
