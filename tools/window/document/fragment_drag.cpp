// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/fragment_drag.hpp"

#include "dsp/core/rotation.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>

namespace tactus::window {

namespace {

// Of the hand in one solution. A step of a real hand at 1 m/s and 20 rad/s.
constexpr double hand_step_m = 1e-3, hand_step_rad = 0.02;
// A solution that moves the body by less than this has arrived.
constexpr double arrived_m = 1e-6, arrived_rad = 1e-5;

/// Of all pairs of bodies that may be tested.
std::size_t points_of(const std::vector<std::shared_ptr<const nodes::BodyParts>>& parts) {
    std::size_t points = 0;
    for (const auto& part : parts) points += part->shell.size();
    return points * parts.size();
}

Vec3 turn_between(const Pose& from, const Pose& to) { return rotation_between(from.orientation, to.orientation); }

bool is_within(const Pose& a, const Pose& b, double distance, double angle) {
    return glm::length(b.position - a.position) < distance && glm::length(turn_between(a, b)) < angle;
}

Pose toward(const Pose& from, const Pose& to) {
    const Vec3 way = to.position - from.position, turn = turn_between(from, to);
    const double most = std::max(glm::length(way) / hand_step_m, glm::length(turn) / hand_step_rad);
    if (most <= 1.0) return to;
    return {from.position + way / most, glm::normalize(rotation_by(turn / most) * from.orientation)};
}

}  // namespace

FragmentDrag::FragmentDrag(std::vector<std::shared_ptr<const nodes::BodyParts>> parts, const fit::Arrangement& now,
                           int fragment)
    : bodies_(parts), now_(now), fragment_(fragment), contact_(points_of(parts)) {
    bodies_.arrange(now_);
    // The others stay where they are, and the group moves with its fragment.
    contact_.set(bodies_.scene(), fragment_, Pose{}, contact::ContactLaw{}, false);
    coupling::QuasiStaticSettings& settings = solver_.settings;
    settings.step = std::min(settings.step, contact_.safe_step());
    settings.reach = contact_.reach();
    settings.gyration = contact_.gyration();
    wanted_ = hand_ = now_.pose(fragment_) * bodies_.home(fragment_);
    solver_.reset(hand_);
}

void FragmentDrag::move(const Vec3& by) {
    wanted_.position += by;
    was_moved_ = true;
    has_arrived_ = false;
}

void FragmentDrag::turn(const Vec3& by) {
    wanted_.orientation = glm::normalize(rotation_by(by) * wanted_.orientation);
    was_moved_ = true;
    has_arrived_ = false;
}

Pose FragmentDrag::goal() noexcept {
    if (fit_) {
        const Pose there = *fit_ * bodies_.home(fragment_);
        const bool is_near = is_attracted_ ? is_within(wanted_, there, released_m, released_rad)
                                           : is_within(wanted_, there, attracted_m, attracted_rad);
        if (is_near != is_attracted_) has_arrived_ = false;
        is_attracted_ = is_near;
        if (is_near) return there;
    } else {
        if (is_attracted_) has_arrived_ = false;
        is_attracted_ = false;
    }
    return wanted_;
}

void FragmentDrag::follow(std::chrono::nanoseconds longest) {
    // A fragment that is only grasped stays where it is, also where it lies in another one.
    if (!was_moved_) return;
    const Pose goal = this->goal();
    const auto until = std::chrono::steady_clock::now() + longest;
    // One solution at least: also a machine that needs longer for it gets there.
    while (!has_arrived_) {
        hand_ = toward(hand_, goal);
        const Pose before = solver_.state().proxy;
        const coupling::QuasiStaticState& state = solver_.update(hand_, contact_);
        has_arrived_ = is_within(hand_, goal, arrived_m, arrived_rad) &&
                       (state.balanced || is_within(before, state.proxy, arrived_m, arrived_rad));
        if (std::chrono::steady_clock::now() >= until) break;
    }
    now_.move(fragment_, solver_.state().proxy * bodies_.home(fragment_).inverse());
}

}  // namespace tactus::window
