// SPDX-License-Identifier: Apache-2.0
// The connected parts of a case during its assembly: their fragments, poses and fits.
#pragma once

#include "dsp/fit/arrangement/arrangement.hpp"
#include "dsp/fit/fragment_matcher.hpp"

#include <functional>
#include <vector>

namespace tactus::analysis {

/// A fit between two fragments of a part: `a` was placed on `b`, or vice versa.
struct AssemblyLink {
    int a = 0, b = 0;
    fit::FragmentMatch match;
    bool was_before = false;  ///< already in the plan
};

/// The shown fragments of a plan in connected parts. Fragments that move together in the plan are one rigid body, and
/// one part from the start; valid fits of the plan also connect.
class AssemblyParts {
public:
    /// `size_of`: returns the area of a fragment's surface, m².
    AssemblyParts(const fit::Arrangement& arrangement, const std::function<double(int)>& size_of);

    /// Returns the part of a fragment, negative if it is hidden.
    int part_of(int fragment) const { return part_[static_cast<std::size_t>(fragment)]; }
    std::vector<int> members(int part) const;
    std::vector<char> mask(int part) const;
    /// Returns `stands` and the locked parts, without the part that moves.
    std::vector<char> and_locked(std::vector<char> stands, int moving) const;
    bool can_move(int part) const;
    /// Returns whether the first part moves to the second when they connect: a locked part stays, otherwise the larger
    /// one.
    bool goes_to(int first, int second) const;

    const std::vector<Pose>& poses() const { return poses_; }
    const Pose& pose(int fragment) const { return poses_[static_cast<std::size_t>(fragment)]; }
    void set_poses(std::vector<Pose> poses) { poses_ = std::move(poses); }

    /// Moves the part of `link.a` so that this fragment gets `pose`, and connects it.
    void connect(AssemblyLink link, const Pose& pose);
    void cut(std::size_t link);
    std::vector<AssemblyLink>& links() { return links_; }

    /// Returns the rigid body of each fragment, negative for hidden ones; and the bodies that do not move while faces
    /// are refined: the locked ones, or one of each part.
    std::vector<int> bodies() const { return body_; }
    std::vector<char> fixed_bodies() const;

    /// Moves each part as a whole so that its reference fragment has its pose in the plan.
    void return_to(const fit::Arrangement& arrangement);
    /// Returns the fits in order from the fixed fragments outwards, most reliable first: `a` goes to `b`.
    std::vector<AssemblyLink> in_order() const;
    /// Returns the fragments of each part, the largest part first.
    std::vector<std::vector<int>> lists() const;
    /// Returns the plan's arrangement with the present poses, and the fragments of one part in a group.
    fit::Arrangement arrangement_moving(const fit::Arrangement& arrangement, int part) const;

private:
    int base_of(const std::vector<int>& members) const;
    void number();

    std::vector<Pose> poses_;
    std::vector<int> part_, body_;
    std::vector<char> locked_, first_;  ///< `first_`: in the plan's largest connected part
    std::vector<double> size_;
    std::vector<AssemblyLink> links_;
};

}  // namespace tactus::analysis
