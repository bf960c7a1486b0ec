// SPDX-License-Identifier: Apache-2.0
// A simulated hand on a device: a rigid mass, pulled by springs and dampers to the pose that the operator intends, and
// pushed by the force of the device.
#pragma once

#include "dsp/core/rotation.hpp"
#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::simulate {

/// Intended pose and motion of the hand.
struct Intention {
    Pose pose;
    Twist twist;
};

/// Hand, handpiece and moving parts of the device. Defaults: a 0.2 kg handpiece in a precision grip, 800 N/m and
/// 15 N·s/m (damping ratio 0.6); all are assumptions within the range published for hands.
struct HandDynamics {
    double mass = 0.2;               ///< kg
    double inertia = 4e-4;           ///< kg·m², the same about every axis
    double stiffness = 800.0;        ///< N/m
    double damping = 15.0;           ///< N·s/m, against the intended velocity
    double strength = HUGE_VAL;      ///< N: the hand pulls towards what it intends with no more
    double angular_stiffness = 2.0;  ///< N·m/rad
    double angular_damping = 0.04;   ///< N·m·s/rad
    double friction = 0.0;           ///< N, Coulomb, of the device
    double drag = 0.0;               ///< N·s/m, of the device, against its base
    double angular_friction = 0.0;   ///< N·m
    double angular_drag = 0.0;       ///< N·m·s/rad
};

/// A hand that grips with this force, N. Both the stiffness and the damping of a gripping hand grow steadily with the
/// grip (Hasser and Cutkosky 2002, for a pinched knob); the slopes are assumptions, chosen so that a precision grip of
/// 5 N has the defaults above and a firm power grip of 50 N is 2.6 times as stiff, at the same damping ratio.
inline HandDynamics gripping(double grip_force) noexcept {
    HandDynamics hand;
    const double stiffer = 1.0 + 0.036 * (std::clamp(grip_force, 0.0, 100.0) - 5.0);
    hand.stiffness *= stiffer;
    hand.damping *= std::sqrt(stiffer);
    hand.angular_stiffness *= stiffer;
    hand.angular_damping *= std::sqrt(stiffer);
    return hand;
}

/// State of the hand. `step` is the implicit midpoint rule: stable for any stiffness and step, and without numerical
/// damping, so that a wall rendered too stiff shows its instability.
struct Hand {
    HandDynamics dynamics;
    Pose pose;
    Twist twist;

    /// Advances by `h` s towards `intended` (its pose and twist in the middle of the step) under `force`, which is
    /// constant during the step. Device frame.
    void step(double h, const Intention& intended, const Wrench& force) noexcept {
        const HandDynamics& d = dynamics;
        if (d.friction > 0.0 || d.drag > 0.0 || d.angular_friction > 0.0 || d.angular_drag > 0.0)
            return step_on_device(h, intended, force);
        const Vec3 away = intended.pose.position - pose.position;
        const double share = share_of_pull(away);
        const Vec3 v = (twist.linear * (2.0 * d.mass / h) + force.force + away * (share * d.stiffness) +
                        intended.twist.linear * (share * d.damping)) /
                       (2.0 * d.mass / h + d.damping + 0.5 * share * d.stiffness * h);
        pose.position += v * h;
        twist.linear = 2.0 * v - twist.linear;

        const Vec3 error = rotation_between(pose.orientation, intended.pose.orientation);
        const Vec3 w = (twist.angular * (2.0 * d.inertia / h) + force.torque + error * d.angular_stiffness +
                        intended.twist.angular * d.angular_damping) /
                       (2.0 * d.inertia / h + d.angular_damping + 0.5 * d.angular_stiffness * h);
        pose.orientation = glm::normalize(rotation_by(w * h) * pose.orientation);
        twist.angular = 2.0 * w - twist.angular;
    }

private:
    /// Of the pull of the grip's spring, what the hand's strength leaves of it.
    double share_of_pull(const Vec3& away) const noexcept {
        const double pull = dynamics.stiffness * glm::length(away);
        return pull > dynamics.strength ? dynamics.strength / pull : 1.0;
    }

    /// The same with the friction of a device. Coulomb friction is implicit: it stops the motion within the step or
    /// takes its whole impulse, so that a hand at rest stays where it is.
    void step_on_device(double h, const Intention& intended, const Wrench& force) noexcept {
        const HandDynamics& d = dynamics;
        const auto slowed = [](const Vec3& v, double most) {
            const double speed = glm::length(v);
            return speed > most ? v * (1.0 - most / speed) : Vec3(0.0);
        };
        const Vec3 away = intended.pose.position - pose.position;
        const double share = share_of_pull(away);
        const double linear = 2.0 * d.mass / h + d.damping + d.drag + 0.5 * share * d.stiffness * h;
        const Vec3 free = (twist.linear * (2.0 * d.mass / h) + force.force + away * (share * d.stiffness) +
                           intended.twist.linear * (share * d.damping)) /
                          linear;
        const Vec3 velocity = slowed(2.0 * free - twist.linear, 2.0 * d.friction / linear);
        pose.position += 0.5 * (twist.linear + velocity) * h;
        twist.linear = velocity;

        const double angular = 2.0 * d.inertia / h + d.angular_damping + d.angular_drag + 0.5 * d.angular_stiffness * h;
        const Vec3 error = rotation_between(pose.orientation, intended.pose.orientation);
        const Vec3 turning = (twist.angular * (2.0 * d.inertia / h) + force.torque + error * d.angular_stiffness +
                              intended.twist.angular * d.angular_damping) /
                             angular;
        const Vec3 spin = slowed(2.0 * turning - twist.angular, 2.0 * d.angular_friction / angular);
        pose.orientation = glm::normalize(rotation_by(0.5 * (twist.angular + spin) * h) * pose.orientation);
        twist.angular = spin;
    }
};

/// Longest internal step of a hand, s.
inline constexpr double hand_substep_s = 0.25e-3;

/// Advances `hand` by `elapsed_s` in equal steps of at most `hand_substep_s`, with the force held. `intend(h, force,
/// pose)` advances the operator by h and returns the intention in the middle of that step. A non-finite force counts as
/// zero, so that a broken wrench does not break the hand.
template <typename Intend>
void advance(Hand& hand, Intend& intend, const Wrench& force, double elapsed_s) noexcept {
    if (!(elapsed_s > 0.0)) return;
    const Wrench felt = is_finite(force) ? force : Wrench{};
    const int steps = static_cast<int>(std::ceil(std::min(elapsed_s, 10.0) / hand_substep_s - 1e-6));
    const double h = elapsed_s / std::max(steps, 1);
    for (int i = 0; i < std::max(steps, 1); ++i) hand.step(h, intend(h, felt, hand.pose), felt);
}

}  // namespace tactus::simulate
