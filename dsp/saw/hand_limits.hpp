// SPDX-License-Identifier: Apache-2.0
// Limits of the hand that leads a saw or a burr.
#pragma once

#include "dsp/core/types.hpp"

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

}  // namespace tactus::saw
