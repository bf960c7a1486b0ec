// SPDX-License-Identifier: Apache-2.0
// Breaks a bone along rough surfaces and simulates CT scans of the fragments: fractures with ground truth.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/volume/grid.hpp"

#include <cstdint>
#include <vector>

namespace tactus::plan {

struct BreakOptions {
    int pieces = 2;
    std::uint64_t seed = 1;
    double roughness = 0.8e-3;   ///< m, root mean square of a fracture's height about its plane
    double tilt = 0.45;          ///< rad, greatest angle between a fracture's normal and the bone's axis
    double chips = 0.0;          ///< fraction of each fracture's area with bone chipped off one side
    double chip_depth = 1.5e-3;  ///< m, of the deepest
    double kerf = 0.0;           ///< m, width of the bone lost along the fracture
};

/// Breaks {distance < 0} and returns the fragments in place, each as a signed distance (m, negative inside, first order
/// near the surface) on the lattice of the bone. Repeatedly breaks the largest piece within its middle third.
/// Deterministic. Throws Error when nothing is inside, for invalid options, and when a piece cannot be broken further.
std::vector<volume::Grid> break_bone(const volume::Grid& distance, const BreakOptions& options);

/// A simulated CT scanner.
struct ScanOptions {
    Vec3 voxel{0.35e-3};
    double blur = 0.25e-3;  ///< m, standard deviation of the point spread
    double noise = 0.03;  ///< standard deviation, in units of the contrast between bone and its surroundings
    std::uint64_t seed = 1;
};

/// Scans a solid moved by `placement`. Returns the distance to its surface in the scan, where the grey value is half
/// way between bone and air, on a grid with a margin of 5 mm. The grid is independent of the solid's lattice. Throws
/// Error when nothing is inside.
volume::Grid scan_solid(const volume::Grid& solid, const Pose& placement, const ScanOptions& options);

}  // namespace tactus::plan
