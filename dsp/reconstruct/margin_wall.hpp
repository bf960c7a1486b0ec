// SPDX-License-Identifier: Apache-2.0
// Where the jaw is cut, and how near to a tumour a cut may come.
#pragma once

#include "dsp/reconstruct/fibula_plan.hpp"
#include "dsp/reconstruct/section.hpp"

#include <span>
#include <vector>

namespace tactus::reconstruct {

/// The first and the last plane, as far as they cut the jaw; normals into what is resected.
std::vector<Plane> resection_planes(const FibulaInputs& inputs);

/// m: how far the tumour, given by points of its surface in the frame of the jaw, lies behind a plane at least; negative
/// where the plane cuts it.
double margin_behind(const Plane& plane, std::span<const Vec3> tumour);

/// Of each of those planes the one parallel to it that keeps `margin`, m, from the tumour: normals to where a cut may be.
std::vector<Plane> margin_walls(const FibulaInputs& inputs, std::span<const Vec3> tumour, double margin);

/// A wall that holds only whoever comes through it: it begins within `radius` of its point, and then reaches as far as
/// the plane until the point is in front of it again. A hand that came another way is free, and so is
/// one that has jumped by more than `radius` since the last call. So a plane across one limb
/// of a jaw stops no hand at the other one.
class OneWayWall {
public:
    Plane plane;
    double radius = 0.0;  ///< m

    /// m behind the wall while it holds, else 0. `is_active`: it may begin to hold.
    double depth(const Vec3& place, bool is_active) noexcept;
    void release() noexcept { holds_ = was_in_front_ = false; }
    bool holds() const noexcept { return holds_; }

private:
    Vec3 before_{0.0};
    bool holds_ = false, was_in_front_ = false;
};

}  // namespace tactus::reconstruct
