// SPDX-License-Identifier: Apache-2.0
// Force of a virtual fixture: a spring to the nearest point of a shape, a damper, and a largest force.
//
// The spring depends on the distance alone, so it has an energy and gives back what it took. The damper only takes. The
// largest force shortens the damper first and the spring by its own law, so both stay true. What is left is sampling: a
// force that is held for a period T gives at most ½·stiffness·|step|² per tick; a damping of stiffness·T·(½ + ticks of
// delay) takes that again (Colgate and Schenkel 1997).
#pragma once

#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::guide {

/// spring + share · damper with the largest share from 0 to 1 that keeps the length within `most`. The spring must be
/// within it.
inline Vec3 limited_sum(const Vec3& spring, const Vec3& damper, double most) noexcept {
    const Vec3 sum = spring + damper;
    if (glm::dot(sum, sum) <= most * most) return sum;
    const double a = glm::dot(damper, damper), b = glm::dot(spring, damper), c = glm::dot(spring, spring) - most * most;
    if (!(a > 0.0)) return spring;
    const double share = (-b + std::sqrt(std::max(b * b - a * c, 0.0))) / a;
    return spring + damper * std::clamp(share, 0.0, 1.0);
}

struct GuideLaw {
    double stiffness = 0.0;  ///< N/m
    double damping = 0.0;  ///< N·s/m
    double max_force = 0.0;  ///< N, of spring and damper together
    double reach = 0.0;  ///< m, distance at which the pull has faded to nothing; 0: it never ends

    /// N: rises with the distance, stays at `max_force`, and falls before `reach` no steeper than it rose.
    double pull(double distance) const noexcept {
        const double spring = std::min(stiffness * distance, max_force);
        return reach > 0.0 ? std::min(spring, stiffness * std::max(reach - distance, 0.0)) : spring;
    }
    /// Share of the damping: 1 near the shape, falling to 0 over the outer half of the reach.
    double grip(double distance) const noexcept {
        return reach > 0.0 ? std::clamp(2.0 * (reach - distance) / reach, 0.0, 1.0) : 1.0;
    }

    /// On a hand from which the nearest point of the shape lies at `offset`. `resisted`: the part of its velocity that
    /// is damped. All m, m/s, N.
    Vec3 attract(const Vec3& offset, const Vec3& resisted) const noexcept {
        const double distance = std::hypot(offset.x, offset.y, offset.z);
        return limited_sum(spring_to(offset), resisted * (-damping * grip(distance)), max_force);
    }
    /// The spring's part of it.
    Vec3 spring_to(const Vec3& offset) const noexcept {
        const double distance = std::hypot(offset.x, offset.y, offset.z);
        return distance > 0.0 ? offset * (pull(distance) / distance) : Vec3(0.0);
    }
    /// On a hand that is `depth` inside of a wall with this normal, which points to where the hand may be. A wall pushes
    /// and never pulls. The damper sets in over the first `onset`: a hand that reaches the wall meets no step of force
    /// (K. H. Hunt, F. R. E. Crossley, J. Applied Mechanics 42, 1975).
    Vec3 repel(double depth, const Vec3& normal, const Vec3& velocity) const noexcept {
        if (!(depth > 0.0)) return Vec3(0.0);
        const double spring = std::min(stiffness * depth, max_force);
        const double damper = damping * std::min(depth / onset, 1.0);
        return normal * std::clamp(spring - damper * glm::dot(velocity, normal), 0.0, max_force);
    }
    static constexpr double onset = 0.2e-3;  ///< m
};

}  // namespace tactus::guide
