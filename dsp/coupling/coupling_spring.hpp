// SPDX-License-Identifier: Apache-2.0
// The two springs between a hand and the proxy of what it holds, one for the place and one for the turn.
#pragma once

#include "dsp/core/rotation.hpp"
#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <limits>
#include <numbers>

namespace tactus::coupling {

/// A spring whose force stays at `limit` once it is stretched that far: energy ½ k u² up to there, straight on beyond.
struct SaturatedSpring {
    double stiffness = 0.0;  ///< N/m or N·m/rad
    double limit = std::numeric_limits<double>::infinity();  ///< N or N·m

    struct Value {
        double energy = 0.0;   ///< J
        Vec3 force{0.0};       ///< d energy / d stretch
        double curvature = 0.0;  ///< of the parabola that touches the energy and never lies below it
    };

    Value operator()(const Vec3& stretch) const noexcept {
        const double length = glm::length(stretch);
        if (stiffness * length <= limit) return {0.5 * stiffness * length * length, stiffness * stretch, stiffness};
        return {limit * length - 0.5 * limit * limit / stiffness, stretch * (limit / length), limit / length};
    }
};

struct CouplingSprings {
    SaturatedSpring linear{1000.0, 10.0}, angular{1.0, 0.5};
};

/// Rotation vector of `to` relative to `from`, of the two ways round the one that is nearer to `before`: a hand that turns
/// on past half a turn keeps being pulled back the way it came.
inline Vec3 rotation_near(const Quat& from, const Quat& to, const Vec3& before) noexcept {
    const Vec3 short_way = rotation_between(from, to);
    const double angle = glm::length(short_way);
    if (angle < 0.5 * std::numbers::pi) return short_way;
    const Vec3 long_way = short_way * (1.0 - 2.0 * std::numbers::pi / angle);
    const Vec3 a = short_way - before, b = long_way - before;
    return glm::dot(a, a) <= glm::dot(b, b) ? short_way : long_way;
}

}  // namespace tactus::coupling
