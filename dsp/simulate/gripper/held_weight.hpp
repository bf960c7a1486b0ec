// SPDX-License-Identifier: Apache-2.0
// A weight on a table that fingers can grip and lift.
#pragma once

#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::simulate {

struct WeightSettings {
    double mass = 0.2;          ///< kg
    double friction = 0.6;      ///< between finger and object
    double stiffness = 600.0;   ///< N/m of the grip
    double damping = 8.0;       ///< N·s/m of the grip
    double gravity = 9.81;      ///< m/s², towards −z
    double table = 0.0;  ///< m, height of the object's origin when it rests
};

/// Point mass. Two fingers that press with N each hold at most 2 μ N (Coulomb friction); beyond that it slides.
struct HeldWeight {
    static constexpr double table_friction = 0.5;

    Vec3 position{0.0}, velocity{0.0};
    Vec3 grip{0.0};  ///< grip point of the object, in the hand's axes
    bool held = false, slides = false;

    /// Force on the hand after `dt` s (semi-implicit Euler).
    Vec3 step(const WeightSettings& s, const Vec3& hand, const Vec3& hand_velocity, double grip_force,
              double dt) noexcept {
        const double most = 2.0 * s.friction * std::max(0.0, grip_force);
        if (!held && most > 0.0) grip = position - hand;
        held = most > 0.0;
        Vec3 pull(0.0);
        slides = false;
        if (held) {
            const Vec3 damp = (hand_velocity - velocity) * s.damping;
            pull = (hand + grip - position) * s.stiffness + damp;
            if (const double size = glm::length(pull); size > most) {
                pull *= most / size;
                slides = true;
                if (s.stiffness > 0.0) grip = position - hand + (pull - damp) / s.stiffness;
            }
        }
        const double depth = s.table - position.z;
        Vec3 force = pull - Vec3(0.0, 0.0, s.mass * s.gravity);
        if (depth > 0.0) {
            constexpr double sink = 0.5e-3;  // m: penetration of the table under the weight's own load
            const double k = s.mass * s.gravity / sink;
            // Damping grows with depth, and friction with the load: a weight that touches the table is not stopped in
            // one step, which the grip would pass on.
            const double load =
                std::max(0.0, k * depth - 1.4 * std::sqrt(k * s.mass) * velocity.z * std::min(1.0, depth / sink));
            force.z += load;
            const double speed = std::hypot(velocity.x, velocity.y);
            const double slowed = std::min(0.5 * s.mass / dt, speed > 0.0 ? table_friction * load / speed : 0.0);
            force.x -= velocity.x * slowed;
            force.y -= velocity.y * slowed;
        }
        velocity += force * (dt / s.mass);
        position += velocity * dt;
        return -pull;
    }
};

}  // namespace tactus::simulate
