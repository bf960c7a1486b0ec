// SPDX-License-Identifier: Apache-2.0
// Logarithm and exponential of rotations.
#pragma once

#include "dsp/core/types.hpp"

#include <cmath>

namespace tactus {

/// Rotation vector of `to` relative to `from`, world axes, shortest rotation: exp(θ) · from = to.
inline Vec3 rotation_between(const Quat& from, const Quat& to) noexcept {
    Quat q = to * glm::conjugate(from);
    if (q.w < 0.0) q = -q;
    const Vec3 v(q.x, q.y, q.z);
    const double sine = glm::length(v);
    return sine < 1e-9 ? 2.0 * v : v * (2.0 * std::atan2(sine, q.w) / sine);
}

/// exp(θ): the rotation about θ by |θ|.
inline Quat rotation_by(const Vec3& theta) noexcept {
    const double angle = glm::length(theta);
    // Near zero the series defines the quotient; its error is below one ulp there.
    const double half_sinc = angle < 1e-6 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
    return {std::cos(0.5 * angle), half_sinc * theta.x, half_sinc * theta.y, half_sinc * theta.z};
}

}  // namespace tactus
