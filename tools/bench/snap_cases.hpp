// SPDX-License-Identifier: Apache-2.0
// Fractures with a known truth, and starts beside it.
#pragma once

#include "dsp/fit/fit_surface.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::bench {

/// What is done to a fracture before the pieces are to be put together.
struct FractureKind {
    const char* name;
    double roughness;  ///< m
    double chips;      ///< share of the area
    double spill;      ///< m, paint beyond the fracture's rim
    double noise;      ///< of the scan, share of the contrast
};

/// How far beside its place a fragment starts.
struct FractureStart {
    double offset_mm, angle_deg;
};

struct FractureCase {
    FractureKind kind;
    std::vector<FractureStart> starts;
};

/// All that success is measured on, by name.
const std::vector<FractureCase>& fracture_cases();

struct FracturePair {
    std::vector<contact::SurfacePoint> moving_points;  ///< of the whole moving piece, in its file's frame
    fit::FitSurface moving, fixed;
    Pose truth;  ///< of the moving piece in the fixed one's frame

    /// Root mean square over the moving piece's surface of how far a pose is from the truth, m.
    double error(const Pose& pose) const;
};

/// Breaks `bone` in two, scans each half as it lies, with a turn of its own, and paints what was not its surface before.
FracturePair make_fracture_pair(const volume::Grid& bone, const FractureKind& kind, std::uint64_t seed);

/// The truth, moved by `offset` (m) and turned by `angle` (rad) about the middle of the moving paint in random
/// directions; if `pushed`, then moved out along the fracture's normal until the paints do not cut into each other.
Pose start_beside(const FracturePair& pair, double offset, double angle, bool pushed, std::uint64_t seed);

}  // namespace tactus::bench
