// SPDX-License-Identifier: Apache-2.0
// Directions and frames of a fibula plan.
#pragma once

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/types.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <string>

namespace tactus::reconstruction {

/// Sine of the angle below which a direction does not define a rotation about an axis.
inline constexpr double min_y = 0.05;
/// rad: largest angle between the normal of a cut and the axis of its segment.
inline constexpr double max_tilt = 75.0 * degree;

/// rad, 0 to pi.
inline double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Returns `v` normalised. Throws Error if it is nearly 0 or not finite.
inline Vec3 direction(const Vec3& v, const std::string& what) {
    const double length = glm::length(v);
    if (!(length > 1e-9 && length < 1e9)) throw Error(fmt::format("{} is no direction", what));
    return v / length;
}

/// Frame with z along `axis` and x = y × z.
inline Mat3 frame_of(const Vec3& axis, const Vec3& y) {
    const Vec3 x = glm::normalize(glm::cross(y, axis));
    return {x, glm::cross(axis, x), axis};
}

}  // namespace tactus::reconstruction
