// SPDX-License-Identifier: Apache-2.0
// Kinematics of a board: the position of the handle, and the motor torques for a force on it.
#pragma once

#include "dsp/core/types.hpp"

#include <array>
#include <optional>

namespace tactus::board {

/// Angles in rad, torques in N·m. Frame of the mechanism: x to its right, y from the motors to the handle.
class Mechanism {
public:
    /// One motor that moves the handle along x: a sector of this radius in m.
    static Mechanism sector(double radius) noexcept;
    /// A five-bar linkage: motors at (−spacing/2, 0) and (spacing/2, 0), angles counter-clockwise from x, the handle on
    /// the side of larger y. Lengths in m.
    static Mechanism pantograph(double proximal, double distal, double spacing) noexcept;

    int motors() const noexcept { return is_sector_ ? 1 : 2; }
    /// Position of the handle, m; nothing if the linkage cannot be closed at these angles.
    std::optional<Vec3> position(const std::array<double, 2>& angles) const noexcept;
    /// τ = Jᵀ F. Zero if the linkage cannot be closed or is fully stretched.
    std::array<double, 2> torques(const std::array<double, 2>& angles, const Vec3& force) const noexcept;

private:
    bool is_sector_ = true;
    double proximal_ = 0.0, distal_ = 0.0, spacing_ = 0.0;
};

}  // namespace tactus::board
