// SPDX-License-Identifier: Apache-2.0
// Fragments of a plan as the mouse moves them: dragged in contact with the others, attracted by a fit, and shown at places
// that are no step yet. The same with and without a run: a drag becomes one command, when it ends. No user interface.
#pragma once

#include "tools/window/document/case_run.hpp"
#include "tools/window/document/fragment_drag.hpp"
#include "tools/window/document/fragment_fits.hpp"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::window {

class FragmentMover {
public:
    FragmentMover(Workbench& bench, CaseRun& run) : bench_(bench), run_(run) {}

    /// Once per picture. `parts`: the bodies of all fragments, in the order of the plan; empty: they are not loaded. A
    /// dragged fragment follows the pointer for as long as a picture may take.
    void tend(const std::vector<std::shared_ptr<const nodes::BodyParts>>& parts);
    /// A fragment may be dragged soon: its plan must be loaded, also in a run.
    bool needs_bodies() const { return needs_bodies_; }

    enum class Taken : std::uint8_t {
        yes,
        not_yet,  ///< the bones are still being loaded, or the step before is on its way to the plan: ask again
        no,
    };
    /// Begins to drag a fragment, from where it is shown. `why`: the reason if it is not taken.
    Taken take(int fragment, std::string* why = nullptr);
    bool is_dragging() const { return drag_.has_value(); }
    const FragmentDrag* drag() const { return drag_ ? &*drag_ : nullptr; }
    /// The fit that attracts the dragged fragment; null: none.
    const FitCandidate* attraction() const { return drag_ && drag_->is_attracted() ? &*fit_ : nullptr; }
    void move(const Vec3& by);
    void turn(const Vec3& by);
    /// Fits attract it, or do not.
    void let_attract(bool wanted) { attracts_ = wanted; }
    /// Leaves it where it is, at the fit that attracts it: one step of the plan, or none if nothing moved.
    void release();
    /// Puts it back to where it was taken.
    void cancel();

    /// Offers another place: shows a fragment, and what moves with it, there; no step. Dragging it on from there ends the
    /// offer.
    void offer(int fragment, const Pose& pose);
    bool offers() const { return offered_.has_value(); }
    /// Ends an offer.
    void show_plan();
    /// Poses of the fragments' files that the scene shows in place of the plan's, by place; empty: none.
    const std::vector<std::optional<Pose>>& poses() const { return poses_; }
    /// Increases with every change of `poses`.
    std::int64_t version() const { return version_; }

private:
    using Clock = std::chrono::steady_clock;
    /// Overrides the poses of the fragment and of what moves with it.
    void show(const fit::Arrangement& now, int fragment);
    void show_at(int fragment, const Pose& pose);
    bool is_step_on_its_way() const;
    void attract();

    Workbench& bench_;
    CaseRun& run_;
    FragmentFits fits_;
    std::vector<std::shared_ptr<const nodes::BodyParts>> parts_;
    std::shared_ptr<const plan::CasePlan> plan_;  // of the drag
    std::optional<FragmentDrag> drag_;
    std::optional<FitCandidate> fit_;
    std::vector<std::optional<Pose>> poses_;
    std::optional<plan::PlaceFragment> offered_;
    std::int64_t version_ = 0;
    std::optional<std::int64_t> left_at_;  // version of the plan: the step is on its way to it
    Clock::time_point left_{};
    bool needs_bodies_ = false, attracts_ = true;
};

}  // namespace tactus::window
