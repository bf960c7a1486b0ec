// SPDX-License-Identifier: Apache-2.0
// Quasi-static virtual coupling: finds the pose of the proxy of a held body at which the springs to the hand and the
// contact forces balance. Without mass and time: each tick lowers the energy
//
//     E(proxy) = contact energy + ψ(p − p_hand) + ψ(log(R R_handᵀ))
//
// by Gauss–Newton steps on rigid motions with Armijo's rule, from the proxy of the previous tick; the curvature that
// Gauss–Newton neglects is learned (dsp/coupling/learned_curvature.hpp). It may stop after any iteration: the proxy is
// always a valid pose and its energy has never increased. After Wan and McNeely 2003 and Barbič and James 2008, with
// the gradient of a contact energy in place of forces along normals.
#pragma once

#include "dsp/contact/pointshell_contact.hpp"
#include "dsp/coupling/coupling_spring.hpp"
#include "dsp/coupling/learned_curvature.hpp"
#include "dsp/coupling/wall_crossing.hpp"
#include "dsp/geometry/symmetric6.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::coupling {

/// What the solver needs: contact of the held body at a trial pose of the handle, about the handle's origin, and a
/// lower bound of the distance that every point can move from there before it touches anything.
template <class T>
concept HeldContactLike = requires(T& contact, const Pose& handle) {
    { contact(handle, contact::ContactParts::all) } -> std::same_as<contact::ContactSum>;
    { contact.clearance(handle) } -> std::convertible_to<double>;
};

struct QuasiStaticSettings {
    CouplingSprings springs;
    int iterations = 10;
    int evaluations = 24;  ///< maximum number of contact evaluations in a tick
    double tolerance = 1e-3;  ///< N: balanced when the residual is below this
    /// m: maximum motion of any point in one iteration beyond the free distance: HeldContact::safe_step or less. Steps
    /// through the middle of a wall of at least four times this thickness are refused (wall_crossing.hpp).
    double step = 0.5e-3;
    /// m: maximum motion of any point in one tick beyond the motion of the hand. A jump over an edge is spread over as
    /// many ticks as needed, so that the spring force changes by no more than this stretches the springs.
    double slip = std::numeric_limits<double>::infinity();
    /// m and rad: the same for the shift and for the turn of the body by themselves, each beyond that of the hand: bounds on the change
    /// of the two springs.
    double shift = std::numeric_limits<double>::infinity(), turn = std::numeric_limits<double>::infinity();
    double reach = 0.05;  ///< m, greatest distance of the held body's points from the handle: the lever of rotations
    double gyration = 0.02;  ///< m: converts a torque to a force for the residual
};

struct QuasiStaticState {
    Pose proxy;  ///< of the handle
    Wrench wrench;  ///< on the hand, about its own origin; in balance equal to the contact's about the proxy
    contact::ContactSum contact;  ///< at the proxy
    double residual = 0.0;  ///< N, of the force balance
    double energy = 0.0;  ///< J, of contact and springs
    double energy_before = 0.0;  ///< J, of the previous proxy with the hand of this tick
    int iterations = 0;  ///< steps taken
    int evaluations = 0;  ///< of the contact
    bool balanced = false;
    bool is_slowed = false;  ///< `slip` ended the tick before it was balanced; the next ticks do the rest
    bool hand_is_valid = true;  ///< false: the pose of the hand was invalid and the last valid one is used
};

class QuasiStaticCoupling {
public:
    QuasiStaticSettings settings;

    /// Starts holding: no force, the proxy at the hand.
    void reset(const Pose& hand) noexcept {
        state_ = {};
        state_.proxy = hand_ = is_valid(hand) ? hand : hand_;
        rotation_ = Vec3(0.0);
        curvature_.forget();
        guard_.forget();
    }

    const QuasiStaticState& state() const noexcept { return state_; }

    template <HeldContactLike Contact>
    const QuasiStaticState& update(const Pose& hand, Contact&& contact) noexcept {
        state_.hand_is_valid = is_valid(hand);
        left_ = settings.slip;
        left_shift_ = settings.shift;
        left_turn_ = settings.turn;
        if (state_.hand_is_valid) {
            const Pose now{hand.position, glm::normalize(hand.orientation)};
            const Vec3 shift = now.position - hand_.position,
                       turn = rotation_between(hand_.orientation, now.orientation);
            left_ += travel_of(shift, turn);
            left_shift_ += glm::length(shift);
            left_turn_ += glm::length(turn);
            hand_ = now;
        }
        state_.iterations = 0;
        state_.evaluations = 0;
        state_.balanced = false;
        Balance now = balance(state_.proxy, contact);
        guard_.see(now.contact, settings.step);
        state_.energy_before = now.energy;
        while (std::isfinite(now.energy)) {
            state_.balanced = residual(now) < settings.tolerance;
            if (state_.balanced || state_.iterations >= settings.iterations || !may_evaluate() || !may_move() ||
                !improve(now, contact))
                break;
            ++state_.iterations;
        }
        state_.is_slowed = !state_.balanced && !may_move();
        state_.residual = residual(now);
        state_.energy = now.energy;
        state_.contact = now.contact;
        rotation_ = now.rotation;
        state_.wrench = {now.linear.force, now.angular.force};
        // An invalid scene gives no force.
        if (!std::isfinite(now.energy) || !is_finite(state_.wrench)) state_.wrench = {};
        return state_;
    }

private:
    struct Balance {
        contact::ContactSum contact;
        SaturatedSpring::Value linear, angular;
        Vec3 rotation{0.0};
        double energy = 0.0;
        geometry::Vector6 gradient{};
    };

    template <class Contact>
    Balance balance(const Pose& proxy, Contact& contact) noexcept {
        Balance b;
        b.contact = contact(proxy, contact::ContactParts::all);
        ++state_.evaluations;
        b.rotation = rotation_near(hand_.orientation, proxy.orientation, rotation_);
        b.linear = settings.springs.linear(proxy.position - hand_.position);
        b.angular = settings.springs.angular(b.rotation);
        b.energy = b.contact.energy + b.linear.energy + b.angular.energy;
        for (int i = 0; i < 3; ++i) {
            const auto n = static_cast<std::size_t>(i);
            b.gradient[n] = b.contact.gradient[n] + b.linear.force[i];
            b.gradient[n + 3] = b.contact.gradient[n + 3] + b.angular.force[i];
        }
        return b;
    }

    bool may_move() const noexcept { return left_ > min_way && left_shift_ > min_way && left_turn_ > min_turn; }
    bool may_evaluate() const noexcept { return state_.evaluations < settings.evaluations; }

    double residual(const Balance& b) const noexcept {
        const geometry::Vector6& g = b.gradient;
        const double lever = std::max(settings.gyration, 1e-6);
        return std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2] +
                         (g[3] * g[3] + g[4] * g[4] + g[5] * g[5]) / (lever * lever));
    }

    /// The Gauss–Newton part.
    static geometry::Matrix6 stiffness(const Balance& b) noexcept {
        geometry::Matrix6 k = b.contact.stiffness;
        for (std::size_t i = 0; i < 3; ++i) {
            k[7 * i] += b.linear.curvature;
            k[7 * (i + 3)] += b.angular.curvature;
        }
        return k;
    }

    /// One descent step; false when none was found.
    template <class Contact>
    bool improve(Balance& now, Contact& contact) noexcept {
        const geometry::Matrix6 known = stiffness(now);
        if (now.contact.in_contact == 0) curvature_.forget();
        rotation_ = now.rotation;
        Step step;
        if (curvature_.is_trusted()) {
            if (!find_step(step, curvature_.added_to(known), now, contact)) curvature_.forget();
            else if (const bool went_down = try_step(step, known, now, contact); curvature_.judge(went_down), went_down)
                return true;
        }
        if (!find_step(step, known, now, contact)) return false;
        for (int halving = 0; halving <= max_halvings && may_evaluate(); ++halving) {
            if (try_step(step, known, now, contact)) return true;
            for (double& s : step.displacement) s *= 0.5;
            step.slope *= 0.5;
        }
        return false;
    }

    struct Step {
        geometry::Vector6 displacement{};
        double slope = 0.0;  ///< derivative of the energy along the step, J
    };

    /// False when there is no descent direction.
    template <class Contact>
    bool find_step(Step& step, const geometry::Matrix6& k, const Balance& now, Contact& contact) const noexcept {
        geometry::Vector6 down{};
        for (std::size_t i = 0; i < 6; ++i) down[i] = -now.gradient[i];
        if (!geometry::solve_symmetric6(k, down, step.displacement)) return false;
        limit(step.displacement, contact);
        step.slope = 0.0;
        for (std::size_t i = 0; i < 6; ++i) step.slope += now.gradient[i] * step.displacement[i];
        return step.slope < 0.0;
    }

    /// Takes the step if the energy decreases sufficiently (Armijo 1966).
    template <class Contact>
    bool try_step(const Step& step, const geometry::Matrix6& known, Balance& now, Contact& contact) noexcept {
        const Pose trial = moved(state_.proxy, step.displacement);
        const Balance there = balance(trial, contact);
        if (!(there.energy <= now.energy + 1e-4 * step.slope)) return false;
        if (guard_.refuses(there.contact, step.displacement, settings.step)) return false;
        guard_.see(there.contact, settings.step);
        geometry::Vector6 change{};
        for (std::size_t i = 0; i < 6; ++i) change[i] = there.gradient[i] - now.gradient[i];
        curvature_.learn(step.displacement, change, known, std::max(settings.gyration, 1e-6));
        state_.proxy = trial;
        now = there;
        left_ -= travel_of(step.displacement);
        left_shift_ -= shift_of(step.displacement);
        left_turn_ -= turn_of(step.displacement);
        return true;
    }

    /// m: upper bound of any point's displacement by this motion.
    double travel_of(const Vec3& shift, const Vec3& rotation) const noexcept {
        return std::hypot(shift.x, shift.y, shift.z) +
               std::hypot(rotation.x, rotation.y, rotation.z) * std::max(settings.reach, 1e-6);
    }
    double travel_of(const geometry::Vector6& step) const noexcept {
        return travel_of(Vec3(step[0], step[1], step[2]), Vec3(step[3], step[4], step[5]));
    }

    static double shift_of(const geometry::Vector6& step) noexcept { return std::hypot(step[0], step[1], step[2]); }
    static double turn_of(const geometry::Vector6& step) noexcept { return std::hypot(step[3], step[4], step[5]); }

    template <class Contact>
    void limit(geometry::Vector6& step, Contact& contact) const noexcept {
        const double travel = travel_of(step), shift = shift_of(step), turn = turn_of(step);
        double most = left_;
        if (travel > settings.step)
            most = std::min(most, settings.step + std::max(0.0, static_cast<double>(contact.clearance(state_.proxy))));
        double share = 1.0;
        if (travel > most) share = most / travel;
        if (shift > left_shift_) share = std::min(share, left_shift_ / shift);
        if (turn > left_turn_) share = std::min(share, left_turn_ / turn);
        for (double& s : step) s *= share;
    }

    static Pose moved(const Pose& pose, const geometry::Vector6& step) noexcept {
        return {pose.position + Vec3(step[0], step[1], step[2]),
                glm::normalize(rotation_by(Vec3(step[3], step[4], step[5])) * pose.orientation)};
    }

    static constexpr int max_halvings = 6;
    static constexpr double min_way = 1e-9, min_turn = 1e-8;  // m, rad
    LearnedCurvature curvature_;
    WallGuard guard_;
    QuasiStaticState state_;
    Pose hand_;
    Vec3 rotation_{0.0};
    double left_ = 0.0;  // m that the points may still move in this tick
    double left_shift_ = 0.0, left_turn_ = 0.0;  // m and rad of the body
};

}  // namespace tactus::coupling
