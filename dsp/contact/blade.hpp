// SPDX-License-Identifier: Apache-2.0
// Contact of a saw blade with a bone: penalty forces at points on the blade.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/volume/bricks.hpp"

#include <array>

namespace tactus::contact {

/// Blade frame: origin in the middle of the tooth edge, x along the blade (the stroke), y the cutting direction,
/// towards the bone, z across the blade.
struct BladeShape {
    double length = 0.040;  ///< m, along x
    double height = 0.010;  ///< m, from the tooth edge back along −y
    double thickness = 0.001;  ///< m, along z
};

inline constexpr int blade_row = 44, blade_rows = 3, blade_point_count = blade_row * blade_rows;

/// 132 points in three rows (thesis 6.2.2): the tooth edge, and both faces at half height. So a blade centred in its
/// kerf receives no side force, a tilted blade receives a torque, and a pinched blade touches both walls.
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

/// Force of point i: k_i·|d|·∇d for d < 0, with d and its exact gradient from a quadratic B-spline. Trilinear gradients
/// would rotate by 10° at every cell face under a narrow kerf.
///
/// `stiffness` K (N/m) is an upper bound of the rendered stiffness. An equal k for every point would be unstable with
/// 132 points in contact, and k divided by the number of contacts would let the force drop whenever another point
/// touches. Therefore each family of points (tooth edge; two faces) has the energy ½·(K/c)·‖d‖₈², the 8-norm over its
/// depths, so k_i = (K/c)·(|d_i|/‖d‖₈)⁶. The force is conservative and continuous and never softens as points come in;
/// the curvature of the energy stays below K. c = 4 for the edge, whose points are pushed in one direction (one tooth
/// alone gives K/4, the whole edge 0.64·K); c = 22 for the faces, which a kerf can pinch from both sides.
/// Deterministic; a pose that is not finite gives no force.
BladeContact blade_contact(const volume::BoneSnapshot& bone, const BladePoints& blade, const Pose& tool,
                           const Vec3& about, double stiffness) noexcept;

}  // namespace tactus::contact
