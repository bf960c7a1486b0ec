// SPDX-License-Identifier: Apache-2.0
// A fragment that is dragged with the mouse: it follows the pointer by the coupling with which a held fragment follows a
// hand, so that it slides along the other bones and does not pass through them. No user interface, no run.
#pragma once

#include "dsp/coupling/held_contact.hpp"
#include "dsp/coupling/quasi_static.hpp"
#include "dsp/fit/arrangement/arrangement.hpp"
#include "nodes/plan/case_bodies.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <vector>

namespace tactus::window {

/// There is no tick and no force on a hand: a slow machine makes the fragment follow later, and drops nothing.
class FragmentDrag {
public:
    /// A fit attracts when the pointer has brought the fragment so near to it ...
    static constexpr double attracted_m = 5e-3, attracted_rad = 0.25;
    /// ... and no longer when it is farther away than this.
    static constexpr double released_m = 8e-3, released_rad = 0.4;

    /// `parts`: the bodies of all fragments, in the order of the plan. `fragment` can be moved in `now`.
    FragmentDrag(std::vector<std::shared_ptr<const nodes::BodyParts>> parts, const fit::Arrangement& now, int fragment);

    int fragment() const { return fragment_; }
    /// Moves the place where the pointer wants the fragment: m, and a rotation vector about its middle, rad.
    void move(const Vec3& by);
    void turn(const Vec3& by);
    /// The pose of its file at which it fits; none: nothing attracts it.
    void attract(const std::optional<Pose>& fit) { fit_ = fit; }
    /// Follows the pointer for at most this time.
    void follow(std::chrono::nanoseconds longest);

    /// It has come as near to the pointer as the other bones let it.
    bool has_arrived() const { return has_arrived_; }
    bool is_attracted() const { return is_attracted_; }
    bool touches() const { return solver_.state().contact.in_contact > 0; }
    bool was_moved() const { return was_moved_; }
    /// The middle of the fragment.
    Vec3 middle() const { return solver_.state().proxy.position; }
    /// All fragments, with this one and its group where they are now.
    const fit::Arrangement& now() const { return now_; }

private:
    Pose goal() noexcept;

    nodes::CaseBodies bodies_;
    fit::Arrangement now_;
    int fragment_;
    coupling::HeldContact contact_;
    coupling::QuasiStaticCoupling solver_;
    Pose wanted_, hand_;  // of the body; the hand goes to the wanted pose in small steps
    std::optional<Pose> fit_;  // of the file
    bool is_attracted_ = false, has_arrived_ = true, was_moved_ = false;
};

}  // namespace tactus::window
