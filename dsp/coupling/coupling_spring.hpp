// SPDX-License-Identifier: Apache-2.0
// The two springs of a virtual coupling, translational and rotational, between the hand and the proxy of a held body.
#pragma once

#include "dsp/core/rotation.hpp"
#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <numbers>

namespace tactus::coupling {

/// A spring with saturated force: energy ½ k u² until the force reaches `limit`, linear beyond.
struct SaturatedSpring {
    double stiffness = 0.0;  ///< N/m or N·m/rad
    double limit = std::numeric_limits<double>::infinity();  ///< N or N·m

    struct Value {
        double energy = 0.0;   ///< J
        Vec3 force{0.0};       ///< d energy / d stretch
        double curvature = 0.0;  ///< of a parabola that touches the energy and is never below it (majorant)
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

/// Rotation vector of `to` relative to `from`; of the two possible ones, the nearer to `before`: a hand that turns
/// beyond half a turn is still pulled back the way it came.
inline Vec3 rotation_near(const Quat& from, const Quat& to, const Vec3& before) noexcept {
    const Vec3 short_way = rotation_between(from, to);
    const double angle = glm::length(short_way);
    if (angle < 0.5 * std::numbers::pi) return short_way;
    const Vec3 long_way = short_way * (1.0 - 2.0 * std::numbers::pi / angle);
    const Vec3 a = short_way - before, b = long_way - before;
    return glm::dot(a, a) <= glm::dot(b, b) ? short_way : long_way;
}

/// A spring in rotation whose torque has no jump: k·θ up to 3/4 of half a turn, and from there in a straight line to 0 at half
/// a turn, where the shortest rotation changes its sign. Conservative over all rotations.
struct TurnSpring {
    static constexpr double straight = 0.75 * std::numbers::pi;  ///< rad

    /// θ of a torque k·θ for the rotation vector `turn`, rad.
    static Vec3 effective(const Vec3& turn) noexcept {
        const double angle = glm::length(turn);
        if (angle <= straight) return turn;
        constexpr double slope = straight / (std::numbers::pi - straight);
        return turn * (slope * std::max(0.0, std::numbers::pi - angle) / angle);
    }
    /// Twice its energy over k, rad².
    static double square(const Vec3& turn) noexcept {
        const double angle = glm::length(turn);
        if (angle <= straight) return angle * angle;
        const double left = std::max(0.0, std::numbers::pi - angle), all = std::numbers::pi - straight;
        return straight * (straight + all - left * left / all);
    }
};

}  // namespace tactus::coupling
