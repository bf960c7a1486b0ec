// SPDX-License-Identifier: Apache-2.0
// Contact of a saw blade with a bone: penalty forces at points on the blade.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/volume/bricks.hpp"

#include <array>

namespace tactus::contact {

/// Blade frame: origin in the middle of the tooth edge, x along the blade (the stroke), y the cutting direction, towards
/// the bone, z across the blade.
struct BladeShape {
    double length = 0.040;  ///< m, along x
    double height = 0.010;  ///< m, from the tooth edge back along −y
    double thickness = 0.001;  ///< m, along z
};

inline constexpr int blade_row = 44, blade_rows = 3, blade_point_count = blade_row * blade_rows;

/// 132 points in three rows (thesis 6.2.2): the tooth edge, and half-way up both faces, so that a blade centred in its
/// kerf feels no side force, a tilted one a torque and a pinched one both walls.
struct BladePoints {
    explicit BladePoints(const BladeShape& shape = {});
    std::array<Vec3, blade_point_count> local;
};

struct BladeContact {
    Wrench wrench;  ///< N and N·m about the given origin, world axes
    double load = 0.0;  ///< N: thrust, the force against the cutting direction, ≥ 0
    double penetration = 0.0;  ///< m, of the deepest point
    int count = 0;  ///< points in contact
};

/// Force of point i: k_i·|d|·∇d for d < 0, with the exact gradient of the interpolated distance, a
/// quadratic B-spline: under a narrow kerf the gradient of a trilinear one would turn by 10° at every cell face.
///
/// `stiffness` K (N/m) is the largest the hand can feel. Equal k for every point in contact would ring with 132 of
/// them, and dividing by their number makes the force drop when one more just touches. Instead each family of points,
/// the tooth edge and the two faces, has the energy ½·(K/c)·‖d‖₈², the 8-norm over its depths, so that
/// k_i = (K/c)·(|d_i|/‖d‖₈)⁶. The force is conservative and continuous, never softens as points come in, and the
/// curvature of the energy, the stiffness felt, stays below K: c = 4 for the edge, whose points are pushed back
/// alike (one tooth alone gives K/4, a whole edge 0.64·K); c = 22 for the faces, which a kerf can pinch from both
/// sides. Deterministic; a pose that is not finite gives nothing.
BladeContact blade_contact(const volume::BoneSnapshot& bone, const BladePoints& blade, const Pose& tool, const Vec3& about,
                           double stiffness) noexcept;

}  // namespace tactus::contact
