// SPDX-License-Identifier: Apache-2.0
// Where the fragments of a case stand, and which of them move as one.
#pragma once

#include "dsp/core/types.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::fit {

/// Fragments with poses, in groups that may hold groups. Fragments and groups are numbered from 0. Memory is taken by
/// the constructor and not later, so that a node may keep one.
class Arrangement {
public:
    static constexpr int none = -1;

    struct Place {
        Pose pose;
        int group = none;
        int fitted_to = none;  ///< the fragment that it was fitted to, as long as it has not moved off
        bool locked = false, hidden = false;
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
    int fitted_to(int fragment) const noexcept { return at(fragment).fitted_to; }
    /// The innermost group of a fragment, the group that holds a group; `none` when there is none.
    int group_of(int fragment) const noexcept { return at(fragment).group; }
    int parent_of(int group) const noexcept { return groups_[static_cast<std::size_t>(group)].parent; }
    bool exists(int group) const noexcept;
    std::size_t most_groups() const noexcept { return groups_.size(); }
    /// The group that holds all others of this fragment, or `none`.
    int outermost(int fragment) const noexcept;
    /// A fragment moves with itself and with all of its outermost group.
    bool move_together(int a, int b) const noexcept;
    /// A locked fragment holds all that move with it.
    bool can_move(int fragment) const noexcept;

    /// Places one fragment and leaves all others: what a recorded step says.
    void place(int fragment, const Pose& pose) noexcept { at(fragment).pose = pose; }
    /// It lies where it fits this one; `none`: it does not.
    void fit(int fragment, int partner) noexcept { at(fragment).fitted_to = partner; }
    /// Moves a fragment to `pose` and all that move with it by the same motion; a pose that is none and what is locked
    /// stay. What leaves its partner behind is fitted no more. Returns whether it moved.
    bool move(int fragment, const Pose& pose) noexcept;

    /// A new group of these fragments and all that move with them: groups among them stay and are held by it. Returns
    /// its number, or `none` for less than two things to join.
    int join(std::span<const int> fragments) noexcept;
    /// A fragment, or the outermost group that it is in, becomes part of a group. False when it is part of it already.
    bool add(int group, int fragment) noexcept;
    /// A fragment leaves all groups. A group that is left with one part is none any more. False when it was in none.
    bool remove(int fragment) noexcept;
    /// The parts of a group stand on their own again, or in the group that held it.
    bool dissolve(int group) noexcept;

    void lock(int fragment, bool locked) noexcept { at(fragment).locked = locked; }
    void hide(int fragment, bool hidden) noexcept { at(fragment).hidden = hidden; }

    // All that is known of a fragment and of a group, for those who remember what was.
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
