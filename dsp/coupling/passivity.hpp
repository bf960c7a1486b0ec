// SPDX-License-Identifier: Apache-2.0
// Time-domain passivity observer and controller (TDPA).
#pragma once

#include "dsp/core/rotation.hpp"
#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::coupling {

/// TDPA after Hannaford and Ryu (2002), for a wrench that is held during a tick: observes the net energy that the hand
/// has put in, by translation and by rotation. The scene is active when it is negative.
class PassivityObserver {
public:
    struct Limits {
        double damping = 50.0;          ///< N·s/m
        double angular_damping = 0.02;  ///< N·m·s/rad
    };
    struct Value {
        Wrench wrench;                 ///< on the hand, with the dampers
        double energy = 0.0;           ///< J, net energy put in by the hand so far
        double damping = 0.0;          ///< N·s/m, of the damper in this tick
        double angular_damping = 0.0;  ///< N·m·s/rad
    };

    /// `wrench` will be held on the hand for `h` s; `hand` is its present pose. The work of a held wrench follows
    /// exactly from the hand's motion. With `control`, force and torque that would give more than was put in, if the
    /// hand moved on as it does, are shrunk (Kim and Ryu 2010), and dampers along the hand's velocity, of at most
    /// `most`, dissipate what is missing: where the scene was active, in rotation or in translation.
    Value operator()(const Wrench& wrench, const Pose& hand, double h, bool control, const Limits& most) noexcept {
        if (is_valid(hand)) observe(hand);
        Value now{wrench, force_.energy + torque_.energy, 0.0, 0.0};
        if (control && is_finite(wrench)) {
            bound(now.wrench, now.energy);
            const double debt = std::max(0.0, -now.energy);
            const double by_force = std::max(0.0, -force_.energy), by_torque = std::max(0.0, -torque_.energy);
            const double share = by_force + by_torque > 0.0 ? by_force / (by_force + by_torque) : 0.0;
            now.damping = damper(force_, debt * share, h, slowest, most.damping);
            now.angular_damping = damper(torque_, debt * (1.0 - share), h, slowest_turn, most.angular_damping);
            now.wrench.force -= now.damping / h * force_.motion;
            now.wrench.torque -= now.angular_damping / h * torque_.motion;
        }
        if (!is_finite(now.wrench) && is_finite(wrench)) now.wrench = {};
        held_ = is_finite(now.wrench) ? now.wrench : Wrench{};
        return now;
    }

private:
    static constexpr double slowest = 1e-6;  // m/s
    static constexpr double slowest_turn = 1e-5;  // rad/s

    /// Translation or rotation.
    struct Part {
        double energy = 0.0;  // J
        Vec3 motion{0.0}, before{0.0};  // in the last tick and in the one before it

        void add(const Vec3& moved, const Vec3& held) noexcept {
            before = motion;
            motion = moved;
            const double sum = energy - glm::dot(held, moved);
            // Beyond any hand: a broken pose must not drown what follows.
            if (std::isfinite(sum)) energy = std::clamp(sum, -1e6, 1e6);
        }
        /// What `held` will give in the next tick, J.
        double gives(const Vec3& held) const noexcept {
            return std::max({0.0, glm::dot(held, motion), glm::dot(held, 2.0 * motion - before)});
        }
    };

    void observe(const Pose& hand) noexcept {
        if (started_) {
            force_.add(hand.position - last_.position, held_.force);
            torque_.add(rotation_between(last_.orientation, hand.orientation), held_.torque);
        }
        last_ = hand;
        started_ = true;
    }

    void bound(Wrench& wrench, double energy) const noexcept {
        const double by_force = force_.gives(wrench.force), by_torque = torque_.gives(wrench.torque);
        const double all = by_force + by_torque, available = std::max(0.0, energy);
        if (!(all > available)) return;
        if (by_force > 0.0) wrench.force *= available / all;
        if (by_torque > 0.0) wrench.torque *= available / all;
    }

    static double damper(const Part& part, double joules, double h, double slowest_of, double most) noexcept {
        const double squared = glm::dot(part.motion, part.motion) / (h * h);
        return squared > slowest_of * slowest_of ? std::min(joules / (h * squared), most) : 0.0;
    }

    Wrench held_;
    Pose last_;
    Part force_, torque_;
    bool started_ = false;
};

}  // namespace tactus::coupling
