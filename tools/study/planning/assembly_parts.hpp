// SPDX-License-Identifier: Apache-2.0
// The parts of a case while it is put together: which fragments hang together, where they are, and by which fits.
#pragma once

#include "dsp/fit/arrangement/arrangement.hpp"
#include "dsp/fit/fragment_matcher.hpp"

#include <functional>
#include <vector>

namespace tactus::study {

/// A fit between two fragments of a part: `a` was placed on `b`, or the other way round.
struct AssemblyLink {
    int a = 0, b = 0;
    fit::FragmentMatch match;
    bool was_before = false;  ///< of the plan
};

/// The shown fragments of a plan in parts. Fragments that move together in the plan are one rigid body, and one part from
/// the start; fits of the plan that hold connect as well.
class AssemblyParts {
public:
    /// `size_of`: m² of a fragment's surface.
    AssemblyParts(const fit::Arrangement& arrangement, const std::function<double(int)>& size_of);

    /// Negative for a hidden fragment.
    int part_of(int fragment) const { return part_[static_cast<std::size_t>(fragment)]; }
    std::vector<int> members(int part) const;
    std::vector<char> mask(int part) const;
    /// `stands` and the parts that are locked, without the part that moves.
    std::vector<char> and_locked(std::vector<char> stands, int moving) const;
    bool can_move(int part) const;
    /// Whether the first moves to the second when they connect: the other way round when it is locked or larger.
    bool goes_to(int first, int second) const;

    const std::vector<Pose>& poses() const { return poses_; }
    const Pose& pose(int fragment) const { return poses_[static_cast<std::size_t>(fragment)]; }
    void set_poses(std::vector<Pose> poses) { poses_ = std::move(poses); }

    /// Moves the part of `link.a` so that this fragment comes to `pose`, and connects it.
    void connect(AssemblyLink link, const Pose& pose);
    void cut(std::size_t link);
    std::vector<AssemblyLink>& links() { return links_; }

    /// The rigid body of each fragment, negative for hidden ones; and which bodies stay while faces are refined: the
    /// locked ones, or one of each part.
    std::vector<int> bodies() const { return body_; }
    std::vector<char> fixed_bodies() const;

    /// Moves each part as a whole so that the fragment of it that stays is where the plan has it.
    void return_to(const fit::Arrangement& arrangement);
    /// The fits from what stays outwards, the surest first: `a` goes to `b`.
    std::vector<AssemblyLink> in_order() const;
    /// The fragments of the parts, the largest part first.
    std::vector<std::vector<int>> lists() const;
    /// As the plan, with the present poses, and the fragments of one part in a group.
    fit::Arrangement arrangement_moving(const fit::Arrangement& arrangement, int part) const;

private:
    int base_of(const std::vector<int>& members) const;
    void number();

    std::vector<Pose> poses_;
    std::vector<int> part_, body_;
    std::vector<char> locked_, first_;  ///< `first_`: of the plan's largest connected part
    std::vector<double> size_;
    std::vector<AssemblyLink> links_;
};

}  // namespace tactus::study
