// SPDX-License-Identifier: Apache-2.0
// Breaks a bone into pieces along rough surfaces, and scans the pieces as a CT would: fractures with a known truth.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/volume/grid.hpp"

#include <cstdint>
#include <vector>

namespace tactus::cases {

struct BreakOptions {
    int pieces = 2;
    std::uint64_t seed = 1;
    double roughness = 0.8e-3;   ///< m, root mean square of a fracture's height about its plane
    double tilt = 0.45;          ///< rad, most that a fracture leans against the bone's axis
    double chips = 0.0;          ///< share of each fracture's area where bone is chipped off one of its sides
    double chip_depth = 1.5e-3;  ///< m, of the deepest
    double kerf = 0.0;           ///< m, bone lost all along the fracture
};

/// The pieces of {distance < 0} where they belong, each as a grid (m, negative inside, near its surface the distance to
/// first order) on samples of the bone's own lattice. The largest piece is broken until there are enough, somewhere in its
/// middle third. The same bone and options give the same pieces. Throws Error when nothing is inside, for options without
/// sense, and when a piece cannot be broken further.
std::vector<volume::Grid> break_bone(const volume::Grid& distance, const BreakOptions& options);

/// What a CT does to a solid.
struct ScanOptions {
    Vec3 voxel{0.35e-3};
    double blur = 0.25e-3;  ///< m, standard deviation of the point spread
    double noise = 0.03;  ///< standard deviation, in units of the contrast between bone and its surroundings
    std::uint64_t seed = 1;
};

/// Scans a solid that was moved by `placement` and returns the distance to its surface in the scan, which lies where the
/// grey value is half way, on samples around it with five millimetres of room. The lattice has nothing to do with the
/// solid's. Throws Error when nothing is inside.
volume::Grid scan_solid(const volume::Grid& solid, const Pose& placement, const ScanOptions& options);

}  // namespace tactus::cases
