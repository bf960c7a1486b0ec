// SPDX-License-Identifier: Apache-2.0
// A force that others take over when a point of a tool comes free.
#pragma once

#include "dsp/core/rotation.hpp"
#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::saw {

/// The springs of a tool share ½·k·‖u‖₈². Where the point with the greatest lag slips off an edge, the norm shrinks and the
/// other points take over the force in one tick, in other directions: a step of some newtons. What a component of the force, in
/// the axes of the tool, gains without a motion of the hand that explains it therefore comes in over `fade_time`. What holds it
/// back is a spring for each axis that is stretched no further and stores no more than the tool has lost in that tick, so that
/// the sum is as passive as the tool. It never turns a force round: what falls, as at a break-through, falls at once.
class TakeOver {
public:
    static constexpr double fade_time = 0.1;  ///< s

    TakeOver() = default;
    /// `stiffness`: N/m, upper bound of what the hand feels; `reach`: m, of the tool about its origin.
    TakeOver(double stiffness, double reach) : stiffness_(stiffness), reach_(reach) {}

    /// One tick of `dt` s: the force of the tool, about its origin, and the energy of its springs. Returns that on the hand.
    Wrench follow(const Wrench& now, double energy, const Pose& pose, double dt) noexcept {
        const Quat back = glm::conjugate(pose.orientation);
        const Wrench force{back * now.force, back * now.torque};
        if (is_on_) {
            const Vec3 way = back * (pose.position - pose_.position);
            const Vec3 turn = back * rotation_between(pose_.orientation, pose.orientation);
            hold(force, energy, way, turn, dt);
        }
        is_on_ = true;
        force_ = force;
        energy_ = energy;
        pose_ = pose;
        return now + Wrench{pose.orientation * back_.force, pose.orientation * back_.torque};
    }

    /// Nothing holds the tool any more.
    void drop() noexcept { *this = TakeOver(stiffness_, reach_); }

private:
    double dot(const Wrench& a, const Wrench& b) const noexcept {
        return glm::dot(a.force, b.force) + glm::dot(a.torque, b.torque) / (reach_ * reach_);
    }

    void hold(const Wrench& now, double energy, const Vec3& way, const Vec3& turn, double dt) noexcept {
        const double after = left_ - dt, kept = after > 1e-9 ? after / left_ : 0.0;
        left_ = std::max(after, 0.0);
        const double lost = energy_ - glm::dot(force_.force, way) - glm::dot(force_.torque, turn) - energy;
        const double moved = 2.0 * stiffness_ * (glm::length(way) + reach_ * glm::length(turn));
        Wrench gained;
        for (int n = 0; n < 3; ++n) {
            back_.force[n] = faded(back_.force[n], spring_ * way[n], kept);
            back_.torque[n] = faded(back_.torque[n], spring_ * reach_ * reach_ * turn[n], kept);
            gained.force[n] = unexplained(force_.force[n], now.force[n], moved);
            gained.torque[n] = unexplained(force_.torque[n], now.torque[n], moved * reach_);
        }
        if (const double stored = spring_ > 0.0 ? dot(back_, back_) / (2.0 * spring_) : 0.0;
            lost > 0.0 && dot(gained, gained) > 0.0) {
            back_ = back_ + gained * -1.0;
            spring_ = dot(back_, back_) / (2.0 * (stored + lost));
            left_ = fade_time;
        }
        for (int n = 0; n < 3; ++n) {
            back_.force[n] = std::clamp(back_.force[n], std::min(-now.force[n], 0.0), std::max(-now.force[n], 0.0));
            back_.torque[n] = std::clamp(back_.torque[n], std::min(-now.torque[n], 0.0), std::max(-now.torque[n], 0.0));
        }
    }
    static double faded(double from, double given_up, double kept) noexcept {
        const double to = from - given_up, most = kept * std::abs(from);
        return to * from > 0.0 ? std::clamp(to, -most, most) : 0.0;
    }
    /// What `to` has beyond `from` in its own direction, and beyond what the motion explains.
    static double unexplained(double from, double to, double moved) noexcept {
        const double more = std::abs(to) - (from * to > 0.0 ? std::abs(from) : 0.0) - moved;
        return more > 0.0 ? std::copysign(more, to) : 0.0;
    }

    double stiffness_ = 0.0, reach_ = 1.0;
    bool is_on_ = false;
    Wrench force_, back_;  // of the tool in the last tick; what holds a rise back; axes of the tool
    double energy_ = 0.0, spring_ = 0.0, left_ = 0.0;  // J, N/m, s
    Pose pose_;
};

}  // namespace tactus::saw
