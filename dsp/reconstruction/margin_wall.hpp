// SPDX-License-Identifier: Apache-2.0
// Cuts of the jaw, and their minimum distance from a tumour.
#pragma once

#include "dsp/reconstruction/fibula_plan.hpp"
#include "dsp/reconstruction/section.hpp"

#include <span>
#include <vector>

namespace tactus::reconstruction {

/// Returns the first and the last plane, if they cut the jaw; normals into the resected part.
std::vector<Plane> resection_planes(const FibulaInputs& inputs);

/// Returns the smallest distance in m of the tumour behind a plane; negative if the plane cuts it. The tumour is given
/// by points of its surface in the frame of the jaw.
double margin_behind(const Plane& plane, std::span<const Vec3> tumour);

/// Returns for each of those planes the parallel one at the distance `margin`, m, from the tumour; normals towards the
/// permitted side.
std::vector<Plane> margin_walls(const FibulaInputs& inputs, std::span<const Vec3> tumour, double margin);

/// A wall that holds only a hand that came through it. It begins to hold within `radius` of its point, and then extends
/// as far as the plane until the point is in front of it again. It does not hold a hand that came by another path or
/// jumped by more than `radius` since the last call. So a plane across one limb of a jaw does not stop a hand at the
/// other one.
/// of a jaw stops no hand at the other one.
class OneWayWall {
public:
    Plane plane;
    double radius = 0.0;  ///< m

    /// Returns the depth in m behind the wall while it holds, otherwise 0. `is_active`: it may begin to hold.
    double depth(const Vec3& place, bool is_active) noexcept;
    void release() noexcept { holds_ = was_in_front_ = false; }
    bool holds() const noexcept { return holds_; }

private:
    Vec3 before_{0.0};
    bool holds_ = false, was_in_front_ = false;
};

}  // namespace tactus::reconstruction
