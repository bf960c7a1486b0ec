// SPDX-License-Identifier: Apache-2.0
// Time-domain passivity observer and controller (TDPA).
#pragma once

#include "dsp/core/rotation.hpp"
#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::coupling {

/// TDPA after Hannaford and Ryu (2002), for a force that is held during a tick: observes the net energy that the hand
/// has put in. The scene is active when it is negative.
class PassivityObserver {
public:
    struct Value {
        Wrench wrench;         ///< on the hand, with the damper
        double energy = 0.0;  ///< J, net energy put in by the hand so far
        double damping = 0.0;  ///< N·s/m, of the damper in this tick
    };

    /// `wrench` will be held on the hand for `h` s; `hand` is its present pose. The work of a held force follows
    /// exactly from the hand's displacement. With `control`, a damper of at most `most_damping` along the hand's
    /// velocity dissipates the missing energy.
    Value operator()(const Wrench& wrench, const Pose& hand, double h, bool control, double most_damping) noexcept {
        Vec3 translation(0.0);
        if (is_valid(hand)) {
            if (started_) {
                translation = hand.position - last_.position;
                const Vec3 rotation = rotation_between(last_.orientation, hand.orientation);
                const double energy = energy_ - glm::dot(held_.force, translation) - glm::dot(held_.torque, rotation);
                if (std::isfinite(energy)) energy_ = energy;
            }
            last_ = hand;
            started_ = true;
        }
        Value now{wrench, energy_, 0.0};
        const Vec3 velocity = translation / h;
        const double speed2 = glm::dot(velocity, velocity);
        if (control && energy_ < 0.0 && speed2 > slowest * slowest) {
            now.damping = std::min(-energy_ / (h * speed2), most_damping);
            now.wrench.force -= now.damping * velocity;
        }
        held_ = is_finite(now.wrench) ? now.wrench : Wrench{};
        return now;
    }

private:
    static constexpr double slowest = 1e-6;  // m/s
    Wrench held_;
    Pose last_;
    double energy_ = 0.0;
    bool started_ = false;
};

}  // namespace tactus::coupling
