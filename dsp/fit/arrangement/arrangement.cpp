// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/arrangement/arrangement.hpp"

#include "dsp/core/rotation.hpp"

#include <glm/geometric.hpp>

namespace tactus::fit {

// Every finished group has two parts or more, so there are fewer groups than fragments; one more is being built.
Arrangement::Arrangement(std::size_t fragments) : places_(fragments), groups_(fragments + 1) {}

bool Arrangement::exists(int group) const noexcept {
    return group >= 0 && static_cast<std::size_t>(group) < groups_.size() &&
           groups_[static_cast<std::size_t>(group)].exists;
}

int Arrangement::top_of(int group) const noexcept {
    while (group != none && parent_of(group) != none) group = parent_of(group);
    return group;
}

int Arrangement::outermost(int fragment) const noexcept { return top_of(group_of(fragment)); }

bool Arrangement::move_together(int a, int b) const noexcept {
    return a == b || (outermost(a) != none && outermost(a) == outermost(b));
}

bool Arrangement::can_move(int fragment) const noexcept {
    for (int other = 0; other < static_cast<int>(size()); ++other)
        if (move_together(fragment, other) && is_locked(other)) return false;
    return true;
}

bool Arrangement::move(int fragment, const Pose& to) noexcept {
    if (!is_valid(to) || !can_move(fragment)) return false;
    const Pose wanted{to.position, glm::normalize(to.orientation)};
    const Pose motion = wanted * pose(fragment).inverse();
    for (int other = 0; other < static_cast<int>(size()); ++other) {
        if (other == fragment || !move_together(fragment, other)) continue;
        Pose& moved = at(other).pose;
        moved = motion * moved;
        moved.orientation = glm::normalize(moved.orientation);
    }
    at(fragment).pose = wanted;
    return true;
}

void Arrangement::fit(int fragment, int partner) noexcept {
    at(fragment).fitted_to = partner;
    at(fragment).beside = partner == none ? Pose{} : pose(partner).inverse() * pose(fragment);
}

Arrangement::Departure Arrangement::departure(int fragment) const noexcept {
    const int partner = was_fitted_to(fragment);
    if (partner == none) return {};
    const Pose now = pose(partner).inverse() * pose(fragment), &then = at(fragment).beside;
    return {glm::length(now.position - then.position),
            glm::length(rotation_between(then.orientation, now.orientation))};
}

int Arrangement::fitted_to(int fragment) const noexcept {
    const Departure away = departure(fragment);
    return away.distance <= void_distance && away.angle <= void_angle ? was_fitted_to(fragment) : none;
}

int Arrangement::join(std::span<const int> fragments) noexcept {
    int units = 0;
    for (std::size_t n = 0; n < fragments.size(); ++n) {
        bool seen = false;
        for (std::size_t m = 0; m < n; ++m) seen = seen || move_together(fragments[m], fragments[n]);
        units += !seen;
    }
    if (units < 2) return none;
    int made = 0;
    while (groups_[static_cast<std::size_t>(made)].exists) ++made;
    for (const int fragment : fragments) {
        const int top = outermost(fragment);
        if (top == made) continue;
        if (top == none) at(fragment).group = made;
        else groups_[static_cast<std::size_t>(top)].parent = made;
    }
    groups_[static_cast<std::size_t>(made)] = {none, true};
    return made;
}

bool Arrangement::add(int group, int fragment) noexcept {
    const int top = outermost(fragment);
    if (!exists(group) || (top != none && top == top_of(group))) return false;
    if (top == none) at(fragment).group = group;
    else groups_[static_cast<std::size_t>(top)].parent = group;
    return true;
}

bool Arrangement::remove(int fragment) noexcept {
    if (group_of(fragment) == none) return false;
    at(fragment).group = none;
    tidy();
    return true;
}

bool Arrangement::dissolve(int group) noexcept {
    if (!exists(group)) return false;
    const int parent = parent_of(group);
    for (Place& place : places_)
        if (place.group == group) place.group = parent;
    for (Group& other : groups_)
        if (other.exists && other.parent == group) other.parent = parent;
    groups_[static_cast<std::size_t>(group)] = {};
    return true;
}

int Arrangement::parts_of(int group) const noexcept {
    int parts = 0;
    for (const Place& place : places_) parts += place.group == group;
    for (const Group& other : groups_) parts += other.exists && other.parent == group;
    return parts;
}

void Arrangement::tidy() noexcept {
    for (bool changed = true; changed;) {
        changed = false;
        for (int group = 0; group < static_cast<int>(groups_.size()); ++group)
            if (exists(group) && parts_of(group) < 2) changed = dissolve(group);
    }
}

}  // namespace tactus::fit
