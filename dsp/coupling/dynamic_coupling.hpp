// SPDX-License-Identifier: Apache-2.0
// Dynamic virtual coupling: the held body has mass, springs and dampers pull it to the hand, contact pushes it.
#pragma once

#include "dsp/coupling/quasi_static.hpp"

namespace tactus::coupling {

struct DynamicSettings {
    CouplingSprings springs;
    double mass = 0.1;               ///< kg
    double inertia = 1e-4;  ///< kg·m², the same about every axis through the handle
    double damping = 10.0;           ///< N·s/m between hand and body
    double angular_damping = 0.01;   ///< N·m·s/rad
    double step = 0.5e-3, reach = 0.05;  ///< m, as in QuasiStaticSettings
};

struct DynamicState {
    Pose proxy;
    Twist twist;
    Wrench wrench;  ///< on the hand: spring and damper
    contact::ContactSum contact;  ///< at the start of the last step, or at the proxy
    bool hand_is_valid = true;
};

/// Linearly implicit (backward) Euler: one contact evaluation and one 6 × 6 system per tick. The stiffness of contact
/// and springs enters implicitly, so the step is stable for any stiffness and time step; fast motion is damped in
/// exchange. With equal inertias the gyroscopic torque is zero.
///
/// No point moves further than `step` beyond the free distance between two evaluations: a faster tick is divided into up
/// to `max_parts` steps. A body that is faster still is held back. One that went through the middle of a wall is put
/// back and stopped (wall_crossing.hpp).
class DynamicCoupling {
public:
    DynamicSettings settings;

    void reset(const Pose& hand) noexcept {
        state_ = {};
        state_.proxy = hand_ = is_valid(hand) ? hand : hand_;
        turn_ = Vec3(0.0);
        moved_ = {};
        guard_.forget();
    }
    const DynamicState& state() const noexcept { return state_; }

    /// `hand_twist` in m/s and rad/s, `h` s > 0.
    template <HeldContactLike Contact>
    const DynamicState& update(const Pose& hand, const Twist& hand_twist, double h, Contact&& contact) noexcept {
        state_.hand_is_valid = is_valid(hand) && is_finite(hand_twist.linear) && is_finite(hand_twist.angular);
        if (state_.hand_is_valid) hand_ = {hand.position, glm::normalize(hand.orientation)};
        const Twist drive = state_.hand_is_valid ? hand_twist : Twist{};
        int parts = 1;
        for (int part = 0; part < parts; ++part) {
            look(contact);
            geometry::Vector6 displacement = displacement_in(h / parts, drive);
            double travel = travel_of(displacement);
            if (travel > settings.step) {
                const double free = std::max(0.0, static_cast<double>(contact.clearance(state_.proxy)));
                const double most = settings.step + free;
                if (part == 0 && travel > most) {
                    parts = static_cast<int>(std::ceil(std::min<double>(max_parts, travel / most)));
                    displacement = displacement_in(h / parts, drive);
                    travel = travel_of(displacement);
                }
                for (double& w : displacement) w *= std::min(1.0, most / travel);
            }
            move(displacement, h / parts);
        }
        if (state_.contact.penetration > settings.step) look(contact);  // deep: not behind the wall at the end either
        const DynamicSettings& s = settings;
        state_.wrench = {s.springs.linear(state_.proxy.position - hand_.position).force +
                             s.damping * (state_.twist.linear - drive.linear),
                         s.springs.angular(turn_).force + s.angular_damping * (state_.twist.angular - drive.angular)};
        if (!is_finite(state_.wrench)) reset(hand_);
        return state_;
    }

private:
    /// Contact at the proxy; after a step through a wall, at the place before that step.
    template <HeldContactLike Contact>
    void look(Contact& contact) noexcept {
        const contact::ContactSum before = state_.contact;
        state_.contact = contact(state_.proxy, contact::ContactParts::all);
        if (guard_.refuses(state_.contact, moved_, settings.step)) {
            state_.proxy = proxy_before_;
            state_.twist = {};
            state_.contact = before;
            moved_ = {};
            turn_ = rotation_near(hand_.orientation, state_.proxy.orientation, turn_);
        }
        guard_.see(state_.contact, settings.step);
    }

    /// (M/h² + D/h + K) δ = M v/h + D v_hand − forces, for the displacement δ of the next h seconds.
    geometry::Vector6 displacement_in(double h, const Twist& drive) noexcept {
        const DynamicSettings& s = settings;
        turn_ = rotation_near(hand_.orientation, state_.proxy.orientation, turn_);
        const auto linear = s.springs.linear(state_.proxy.position - hand_.position);
        const auto angular = s.springs.angular(turn_);
        geometry::Matrix6 k = state_.contact.stiffness;
        geometry::Vector6 push{}, displacement{};
        for (int i = 0; i < 3; ++i) {
            const auto n = static_cast<std::size_t>(i);
            k[7 * n] += s.mass / (h * h) + s.damping / h + linear.curvature;
            k[7 * (n + 3)] += s.inertia / (h * h) + s.angular_damping / h + angular.curvature;
            push[n] = s.mass / h * state_.twist.linear[i] + s.damping * drive.linear[i] - linear.force[i] -
                      state_.contact.gradient[n];
            push[n + 3] = s.inertia / h * state_.twist.angular[i] + s.angular_damping * drive.angular[i] -
                          angular.force[i] - state_.contact.gradient[n + 3];
        }
        if (!geometry::solve_symmetric6(k, push, displacement)) state_.twist = {};
        return displacement;
    }

    /// m: upper bound of any point's motion.
    double travel_of(const geometry::Vector6& d) const noexcept {
        return std::hypot(d[0], d[1], d[2]) + std::hypot(d[3], d[4], d[5]) * std::max(settings.reach, 1e-6);
    }

    void move(const geometry::Vector6& displacement, double h) noexcept {
        const Vec3 v(displacement[0], displacement[1], displacement[2]),
            w(displacement[3], displacement[4], displacement[5]);
        proxy_before_ = state_.proxy;
        moved_ = displacement;
        state_.proxy.position += v;
        state_.proxy.orientation = glm::normalize(rotation_by(w) * state_.proxy.orientation);
        state_.twist = {v / h, w / h};
        turn_ = rotation_near(hand_.orientation, state_.proxy.orientation, turn_);
    }

    static constexpr int max_parts = 8;
    DynamicState state_;
    WallGuard guard_;
    Pose hand_, proxy_before_;
    geometry::Vector6 moved_{};  // from proxy_before_ to the proxy
    Vec3 turn_{0.0};
};

}  // namespace tactus::coupling
