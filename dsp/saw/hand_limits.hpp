// SPDX-License-Identifier: Apache-2.0
// Limits of the hand that leads a saw or a burr.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/volume/bricks.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::saw {

inline constexpr double fastest_hand = 3.0;  // m/s: faster is a jump
inline constexpr double max_lag = 0.020;  // m: the force of a point does not grow beyond this distance from the tool
inline constexpr double dry_friction = 0.3;  // of a tool that stands still, steel on bone

/// True if no hand moves a tool of `reach` m about its origin from one pose to the other in `dt` s.
inline bool is_jump(const Pose& from, const Pose& to, double reach, double dt) noexcept {
    const double cosine = std::min(std::abs(glm::dot(from.orientation, to.orientation)), 1.0);
    const double turn = 2.0 * std::sqrt(1.0 - cosine * cosine);  // half of it is the sine of half of the angle
    return glm::length(to.position - from.position) + reach * turn > std::max(fastest_hand * dt, 0.001);
}

/// True if a ball goes straight from one place to the other without bone in its way; where it touches bone it may leave it.
/// Steps by the distance to the bone (sphere tracing, Hart 1996): a hand may move a tool by many voxels in one tick, past
/// the corner of a bone. `step`: m, the least.
template <class Field>
bool is_way_free(const Field& bone, const Vec3& from, const Vec3& to, double radius, double step) noexcept {
    constexpr int max_steps = 48;
    constexpr double rounding = 1e-9;  // m
    const double way = glm::length(to - from);
    double gap = bone.value(from) - radius, gone = 0.0;
    for (int n = 0; n < max_steps && gone < way; ++n) {
        gone = std::min(gone + std::max(gap, step), way);
        const double next = bone.value(from + (to - from) * (gone / way)) - radius;
        // Nearer than a step to bone it may only go away from it.
        if (next < step && next < gap + rounding) return false;
        gap = next;
    }
    return gone >= way && gap >= 0.0;
}

}  // namespace tactus::saw
