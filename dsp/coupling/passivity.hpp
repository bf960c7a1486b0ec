// SPDX-License-Identifier: Apache-2.0
// Does a scene give the hand more energy than it took, and a damper that takes it back.
#pragma once

#include "dsp/core/rotation.hpp"
#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::coupling {

/// Passivity observer and controller in the time domain (Hannaford and Ryu 2002), with the force of a tick held until
/// the next: the energy that the hand put in so far, less what it got back. Below zero the scene is active.
class PassivityObserver {
public:
    struct Value {
        Wrench wrench;         ///< on the hand, with the damper
        double energy = 0.0;   ///< J, put in by the hand so far
        double damping = 0.0;  ///< N·s/m, of the damper in this tick
    };

    /// `wrench` on the hand is what is about to be held for `h` s, `hand` where the hand is now. The work of a held force
    /// is known exactly by where the hand went. With `control`, a damper of at most `most_damping` along the hand's
    /// movement takes back what is missing.
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
