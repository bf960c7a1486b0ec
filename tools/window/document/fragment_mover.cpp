// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/fragment_mover.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <utility>

namespace tactus::window {

namespace {

// Half of a picture at 60 Hz. A fragment that needs longer follows in the next pictures.
constexpr auto follows_for = std::chrono::milliseconds(8);
// From a step that was given to its version of the plan. A step that is refused has none.
constexpr auto longest_on_way = std::chrono::seconds(2);

}  // namespace

void FragmentMover::tend(const std::vector<std::shared_ptr<const nodes::BodyParts>>& parts) {
    parts_ = parts;
    if (left_at_ && !is_step_on_its_way()) show_plan();
    if (!drag_) return;
    if (run_.newest() != plan_) {
        bench_.tell("the plan was changed meanwhile: the dragged fragment is where the plan has it", true);
        return cancel();
    }
    attract();
    drag_->follow(follows_for);
    show(drag_->now(), drag_->fragment());
}

/// A command that waits, as in a pause, is not late.
bool FragmentMover::is_step_on_its_way() const {
    return left_at_ && *left_at_ == run_.version() && (run_.is_asked() || Clock::now() - left_ < longest_on_way);
}

FragmentMover::Taken FragmentMover::take(int fragment, std::string* why) {
    const auto refuse = [&](std::string reason, Taken how = Taken::no) {
        if (why) *why = std::move(reason);
        return how;
    };
    if (drag_ || !run_.can_give() || !run_.newest()) return refuse("there is no plan that can be changed now");
    const plan::CasePlan& plan = *run_.newest();
    if (fragment < 0 || fragment >= static_cast<int>(plan.fragments.size())) return refuse("this is no fragment");
    const std::string& name = plan.fragments[static_cast<std::size_t>(fragment)].name;
    needs_bodies_ = true;
    if (parts_.size() != plan.fragments.size()) return refuse("the bones are still being loaded", Taken::not_yet);
    if (is_step_on_its_way()) return refuse("the step before is not in the plan yet", Taken::not_yet);
    fit::Arrangement now = plan::state_of(plan).arrangement;
    const int held = run_.held_last();
    if (run_.is_holding() && held >= 0 && now.move_together(fragment, held))
        return refuse(fmt::format("a hand holds {}, or one of its group", name));
    if (!now.can_move(fragment)) return refuse(fmt::format("{}, or one of its group, is locked", name));
    if (offered_ && !now.move_together(fragment, offered_->fragment))
        return refuse(fmt::format("a place for {} is to be chosen first: put it there, or leave it",
                                  plan.fragments[static_cast<std::size_t>(offered_->fragment)].name));
    if (offered_) now.move(offered_->fragment, offered_->pose);
    plan_ = run_.newest();
    left_at_.reset();
    fit_.reset();
    fits_.forget_near();
    drag_.emplace(parts_, now, fragment);
    return Taken::yes;
}

/// A fit near to where the fragment is now.
void FragmentMover::attract() {
    if (!drag_->was_moved()) return;
    const int fragment = drag_->fragment();
    if (const FitCandidate* const found = fits_.near(fragment)) fit_ = *found;
    fits_.look_near(plan_, drag_->now(), fragment);
    if (std::string problem = fits_.take_problem(); !problem.empty())
        bench_.tell(fmt::format("no fit attracts a fragment: {}", problem), true);
    drag_->attract(fit_ && attracts_ ? std::optional(fit_->step.pose) : std::nullopt);
}

void FragmentMover::move(const Vec3& by) {
    if (drag_) drag_->move(by);
}

void FragmentMover::turn(const Vec3& by) {
    if (drag_) drag_->turn(by);
}

void FragmentMover::release() {
    if (!drag_) return;
    const bool is_fitted = drag_->is_attracted() && fit_;
    const Pose pose = drag_->now().pose(drag_->fragment());
    const int fragment = drag_->fragment();
    if (!drag_->was_moved()) return cancel();
    drag_.reset();
    offered_.reset();
    if (is_fitted) {
        show_at(fragment, fit_->step.pose);
        run_.give(fit_->step);
    } else run_.give(plan::PlaceFragment{fragment, pose});
    // The scene shows the fragment where it was left until the plan has the step.
    left_at_ = run_.version();
    left_ = Clock::now();
}

void FragmentMover::cancel() {
    drag_.reset();
    if (offered_ && run_.newest() == plan_) show_at(offered_->fragment, offered_->pose);
    else show_plan();
}

void FragmentMover::offer(int fragment, const Pose& pose) {
    left_at_.reset();
    offered_ = {fragment, pose};
    show_at(fragment, pose);
}

void FragmentMover::show(const fit::Arrangement& now, int fragment) {
    std::vector<std::optional<Pose>> poses;
    for (int n = 0; n < static_cast<int>(now.size()); ++n)
        poses.push_back(now.move_together(fragment, n) ? std::optional(now.pose(n)) : std::nullopt);
    poses_ = std::move(poses);
    ++version_;
}

void FragmentMover::show_at(int fragment, const Pose& pose) {
    if (!run_.newest()) return;
    fit::Arrangement now = plan::state_of(*run_.newest()).arrangement;
    now.move(fragment, pose);
    show(now, fragment);
}

void FragmentMover::show_plan() {
    left_at_.reset();
    offered_.reset();
    if (poses_.empty()) return;
    poses_.clear();
    ++version_;
}

}  // namespace tactus::window
