// SPDX-License-Identifier: Apache-2.0
// Poses of a case's fragments, and their groups.
#pragma once

#include "dsp/core/types.hpp"

#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

namespace tactus::fit {

/// Fragments with poses, in nested groups. Fragments and groups are numbered from 0. Allocates in the constructor only,
/// so that a node may own one.
class Arrangement {
public:
    static constexpr int none = -1;

    /// A fit becomes void when one fragment moves farther than this from its fitted pose in the partner's frame.
    static constexpr double void_distance = 0.05e-3;  ///< m, of the origin of the fragment's file
    static constexpr double void_angle = 0.05 * std::numbers::pi / 180.0;  ///< rad

    struct Place {
        Pose pose;
        int group = none;
        int fitted_to = none;  ///< the fragment to which it was fitted last
        Pose beside;  ///< its pose in that fragment's frame when it was fitted
        bool locked = false, hidden = false;
    };
    /// Displacement of a fragment from its fitted pose, in its partner's frame: m and rad.
    struct Departure {
        double distance = 0.0, angle = 0.0;
    };
    struct Group {
        int parent = none;
        bool exists = false;
    };

    explicit Arrangement(std::size_t fragments);

    std::size_t size() const noexcept { return places_.size(); }
    const Pose& pose(int fragment) const noexcept { return at(fragment).pose; }
    bool is_locked(int fragment) const noexcept { return at(fragment).locked; }
    bool is_hidden(int fragment) const noexcept { return at(fragment).hidden; }
    /// Returns the partner of the fragment's fit, if neither has moved from the other since; otherwise `none`.
    int fitted_to(int fragment) const noexcept;
    /// Returns the partner of the last fit, even if that fit is void.
    int was_fitted_to(int fragment) const noexcept { return at(fragment).fitted_to; }
    /// Displacement since it was fitted; zero if it never was.
    Departure departure(int fragment) const noexcept;
    /// Returns the innermost group of a fragment, or the parent of a group; `none` if there is none.
    int group_of(int fragment) const noexcept { return at(fragment).group; }
    int parent_of(int group) const noexcept { return groups_[static_cast<std::size_t>(group)].parent; }
    bool exists(int group) const noexcept;
    std::size_t max_groups() const noexcept { return groups_.size(); }
    /// The outermost group of the fragment, or `none`.
    int outermost(int fragment) const noexcept;
    /// True for the fragment itself and all members of its outermost group.
    bool move_together(int a, int b) const noexcept;
    /// Returns false if a locked fragment moves together with this one.
    bool can_move(int fragment) const noexcept;

    /// Places one fragment without its group, to replay a recorded step.
    void place(int fragment, const Pose& pose) noexcept { at(fragment).pose = pose; }
    /// Records that the fragment fits this partner at their current poses; `none` removes the fit.
    void fit(int fragment, int partner) noexcept;
    /// Moves a fragment to `pose` and everything that moves with it by the same motion; ignores an invalid pose and
    /// locked fragments. Fits to fragments outside of this motion become void. Returns whether the fragment moved.
    bool move(int fragment, const Pose& pose) noexcept;

    /// Makes a group of these fragments and all that move with them: their groups become nested groups. Returns its
    /// number, or `none` for fewer than two members.
    int join(std::span<const int> fragments) noexcept;
    /// Adds a fragment, or its outermost group, to a group. Returns false if it is already a member.
    bool add(int group, int fragment) noexcept;
    /// Removes a fragment from all groups. Dissolves a group with one member left. Returns false if the fragment was in
    /// no group.
    bool remove(int fragment) noexcept;
    /// Dissolves a group: its members move to the parent group, or become independent.
    bool dissolve(int group) noexcept;

    void lock(int fragment, bool locked) noexcept { at(fragment).locked = locked; }
    void hide(int fragment, bool hidden) noexcept { at(fragment).hidden = hidden; }

    // The complete state of a fragment and of a group, for undo.
    const Place& fragment(int n) const noexcept { return at(n); }
    const Group& group(int n) const noexcept { return groups_[static_cast<std::size_t>(n)]; }
    void restore(int fragment, const Place& place) noexcept { at(fragment) = place; }
    void restore(int group, const Group& was) noexcept { groups_[static_cast<std::size_t>(group)] = was; }

private:
    Place& at(int fragment) noexcept { return places_[static_cast<std::size_t>(fragment)]; }
    const Place& at(int fragment) const noexcept { return places_[static_cast<std::size_t>(fragment)]; }
    int top_of(int group) const noexcept;
    int parts_of(int group) const noexcept;
    void tidy() noexcept;

    std::vector<Place> places_;
    std::vector<Group> groups_;
};

}  // namespace tactus::fit
