// SPDX-License-Identifier: Apache-2.0
// Angle of an orientation about an axis.
#pragma once

#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <cmath>

namespace tactus::guide {

struct TwistAngle {
    double angle = 0.0;   ///< rad, from −π to π: the twist of the swing–twist decomposition (Dobrowolski 2015)
    Vec3 gradient{0.0};   ///< rad per rad: the angle changes at gradient · angular velocity, world axes
};

/// `axis` of length 1. From q' = ½ ω q follows the rate of 2 atan2(v·axis, w). An orientation that is tilted by half a
/// turn has no twist: 0, and no gradient.
inline TwistAngle twist_angle(const Quat& q, const Vec3& axis) noexcept {
    const Vec3 v(q.x, q.y, q.z);
    const double along = glm::dot(v, axis), size = q.w * q.w + along * along;
    if (!(size > 1e-9)) return {};
    // q and -q are one orientation.
    const double sign = q.w < 0.0 ? -1.0 : 1.0;
    return {2.0 * std::atan2(sign * along, sign * q.w),
            (axis * (q.w * q.w) + glm::cross(v, axis) * q.w + v * along) / size};
}

}  // namespace tactus::guide
