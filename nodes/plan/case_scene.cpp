// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/arrangement/arrangement.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/node.hpp"
#include "graph/node/notice.hpp"
#include "graph/node/visual.hpp"
#include "nodes/plan/case_bodies.hpp"
#include "nodes/plan/step_record.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tactus::nodes {

struct CaseScene {
    static constexpr auto about =
        "The fragments of a plan as one scene. The held fragment and its group follow the coupling. Releasing, "
        "settling, joining, splitting, locking and hiding are steps that can be undone, as are the steps already in "
        "the plan. Every step is written to the plan's file soon after it is done.";

    In<Pose> moved{optional, "pose that the coupling gives the body at place 'which'", "m"};
    In<double> which{optional, "place of the held body; -1: none"};
    In<bool> holding{optional, "the body is held; when it is released it stays where it was last"};
    In<Pose> target{optional, "pose of the held body for the fit: fragment_matcher.target", "m"};
    In<bool> fits{optional, "there is a fit"};
    In<double> target_of{optional,
                         "place of the body that the target is for: fragment_matcher.fragment, which may lag behind"};
    In<double> partner{optional, "place of the body that it fits"};
    In<double> score{optional, "of the fit"};
    In<double> margin{optional, "of the fit, to the second best"};
    In<double> rms{optional, "of the fit", "m"};
    In<double> gap{optional, "of the fit", "m"};
    In<double> penetration{optional, "of the fit", "m"};
    In<double> overlap{optional, "of the fit", "m^2"};
    In<bool> settle{optional, "pressed: put the held body where it fits; it stays there"};
    In<bool> join{optional, "pressed: the held body moves with its partner from now on"};
    In<bool> split{optional, "pressed: the held body leaves all groups"};
    In<bool> lock{optional, "pressed: lock or unlock the held body"};
    In<bool> hide{optional, "pressed: hide the body that was held last"};
    In<bool> show{optional, "pressed: show all hidden bodies"};
    In<bool> undo{optional, "pressed: undo one step"};
    In<bool> redo{optional, "pressed: redo one step"};
    Out<tactus::coupling::Scene> scene{"for grasp, coupling and fragment_matcher nodes"};
    Out<double> steps{"number of steps done, without undone ones"};
    Out<bool> settled{"the held body has been put where it fits"};
    Asset<plan::CaseBones> plan{"the plan with its fragments; new steps follow its current one"};
    Text file{"case.plan.json", "name of the plan file with the steps of the run, in the run folder; empty: none"};
    Param loose{"8 mm", "0.1 mm", "100 mm",
                "a settled body is free again when the hand moves it farther than this from where it settled"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::scene, .value = "scene", .asset = "plan"},
                {.kind = VisualKind::asset_bone, .value = "scene", .asset = "plan"}};
    }

    Param choose{discrete, "-1", "-1", "15",
                 "place of the body that join, split, lock and hide mean; -1: the one that was held last"};
    Param alternative{discrete, "-1", "-1", "31",
                      "changed: go to this alternative of the plan, the first is 0; their number: begin another one at "
                      "the current state; -1: stay"};
    Param drop{discrete, "-1", "-2", "31",
               "changed: drop this alternative, which must not be the current one; its steps stay; -2: bring the one "
               "dropped last back; -1: none"};
    Param with{discrete, "-1", "-1", "15",
               "place of the body that join puts together with it; -1: the partner of the fit"};

    void prepare(const Setup& setup) {
        if (plan->bones.size() > tactus::coupling::Scene::max_objects)
            setup.fail("plan '" + plan.name +
                       "' has more than 16 fragments; hiding does not help: plan the case in parts");
        name_ = setup.name;
        for (Notice* notice : {&held_back_, &no_earlier_, &no_later_, &no_fit_, &no_alternative_})
            notice->attach(setup);
        bodies_ = std::make_unique<CaseBodies>(plan->bones);
        if (plan->plan.alternatives.size() > plan::PlanHistory::max_alternatives)
            setup.fail("plan '" + plan.name +
                       "' has more than 32 alternatives; remove some: 'tactus plan alternative'");
        history_ = std::make_unique<plan::PlanHistory>(plan->plan);
        now_ = std::make_unique<fit::Arrangement>(history_->now());
        given_ = 0;
        wanted_alternative_ = alternative;
        wanted_drop_ = drop;
        if (!file.value.empty()) {
            keeper_ = std::make_shared<StepKeeper>(plan->plan, setup.period);
            stream_ = &setup.host->record({file.value, "", &plan_record_type, setup.period, keeper_}, setup.where);
        }
        bodies_->arrange(*now_);
        publish();
    }

    void process(const Tick& tick) noexcept {
        follow(tick);
        press(tick);
        choose_alternative(tick);
        publish();
    }

    void report(Report& report) const {
        report.set(name_, "steps",
                   static_cast<double>(history_->count()) - static_cast<double>(plan->plan.steps.size()));
        if (not_kept_) report.set(name_, "steps_not_kept", 1.0);
        if (keeper_ && !keeper_->trouble().empty()) report.set(name_, "error", keeper_->trouble());
    }

private:
    int held() const noexcept {
        if (!which.connected || !moved.connected) return -1;
        const double place = which.get();
        return place >= 0.0 && place < static_cast<double>(bodies_->count()) ? static_cast<int>(place) : -1;
    }
    Pose file_pose(int fragment, const Pose& body) const noexcept { return body * bodies_->home(fragment).inverse(); }

    /// The held body and its group follow the coupling.
    void follow(const Tick& tick) noexcept {
        const int place = held();
        const bool wanted = place >= 0 && (!holding.connected || holding.get());
        if (holding_ && (!wanted || place != last_)) keep_last(tick);
        if (!wanted || place != last_ || !holding_) settled_ = false;
        holding_ = wanted;
        if (!wanted) return;
        last_ = place;
        if (!is_valid(moved.get())) return;
        const Pose here = file_pose(place, {moved->position, glm::normalize(moved->orientation)});
        if (settled_) {
            // The offset between hand and body at settling does not count.
            if (!(glm::length(middle_at(here) - let_at_) > loose)) return;
            settled_ = false;
        }
        if (now_->move(place, here)) bodies_->show_unit(*now_, place);
    }

    void press(const Tick& tick) noexcept {
        const bool settles = edge(settle, 0) && holding_;
        if (settles && !has_fit()) no_fit_.tell();
        if (settles && has_fit() && moved.connected && is_valid(moved.get()) && give(tick, settling())) {
            settled_ = true;
            let_at_ = middle_at(file_pose(last_, {moved->position, glm::normalize(moved->orientation)}));
        }
        const int meant = place_of(choose, last_);
        if (edge(join, 1) && meant >= 0) {
            const int other = place_of(with, partner_place());
            keep_held(tick);
            if (other >= 0) give(tick, plan::JoinFragments{meant, other});
        }
        if (edge(split, 2) && meant >= 0) {
            keep_held(tick);
            give(tick, plan::SplitFragment{meant});
        }
        if (edge(lock, 3) && meant >= 0) {
            keep_held(tick);
            give(tick, plan::LockFragment{meant, !now_->is_locked(meant)});
        }
        if (edge(hide, 6) && meant >= 0 && !now_->is_hidden(meant)) {
            keep_held(tick);
            give(tick, plan::HideFragment{meant});
        }
        if (edge(show, 7) && has_hidden()) {
            keep_held(tick);
            give(tick, plan::ShowFragments{});
        }
        const bool back = edge(undo, 4), on = edge(redo, 5);
        if ((back || on) && holding_) held_back_.tell();
        else if (back != on) {
            const plan::PlanCommand command =
                back ? plan::PlanCommand(plan::UndoStep{}) : plan::PlanCommand(plan::RedoStep{});
            if (!give(tick, command)) (back ? no_earlier_ : no_later_).tell();
        }
    }

    /// Applies a command to the plan, shows the result and records it. Returns false if it changed nothing.
    bool give(const Tick& tick, const plan::PlanCommand& command) noexcept {
        const bool is_done = history_->apply(command) == plan::PlanHistory::Outcome::done;
        // What the hand has moved since the last step is part of the command, or void.
        *now_ = history_->now();
        bodies_->arrange(*now_);
        if (!is_done) return false;
        const plan::PlanRecord record{given_++, command};
        if (stream_ && !stream_->write(tick.index, &record, 1, sizeof record)) not_kept_ = true;
        return true;
    }

    plan::SettleFragment settling() const noexcept {
        const auto figure = [](const In<double>& of) { return of.connected ? of.get() : 0.0; };
        return {last_,
                partner_place(),
                file_pose(last_, {target->position, glm::normalize(target->orientation)}),
                {figure(score), figure(margin), figure(rms), figure(gap), figure(penetration), figure(overlap)}};
    }

    /// Whether a parameter was set to something else; it is then as it was set.
    static bool is_changed(const Param& param, double& was) noexcept {
        return param != std::exchange(was, static_cast<double>(param)) && param != -1.0;
    }

    void choose_alternative(const Tick& tick) noexcept {
        const bool goes = is_changed(alternative, wanted_alternative_), drops = is_changed(drop, wanted_drop_);
        if (!goes && !drops) return;
        if (holding_) return held_back_.tell();
        const double to = alternative, away = drop;
        if ((goes && to != std::floor(to)) || (drops && away != std::floor(away))) return no_alternative_.tell();
        if (goes && !give(tick, plan::GoToAlternative{static_cast<int>(to)})) no_alternative_.tell();
        if (!drops) return;
        const plan::PlanCommand command = away < 0.0 ? plan::PlanCommand(plan::RestoreAlternative{})
                                                     : plan::PlanCommand(plan::DropAlternative{static_cast<int>(away)});
        if (!give(tick, command)) no_alternative_.tell();
    }

    /// True when there is a fit for the held body.
    bool has_fit() const noexcept {
        return fits.connected && fits.get() && target.connected && is_valid(target.get()) &&
               (!target_of.connected || target_of.get() == static_cast<double>(last_));
    }

    /// Moving a body by hand is a step of its own, before what is done to the body there.
    void keep_held(const Tick& tick) noexcept {
        if (holding_) keep_last(tick);
    }
    void keep_last(const Tick& tick) noexcept {
        if (!settled_ && last_ >= 0 && now_->can_move(last_)) give(tick, plan::PlaceFragment{last_, now_->pose(last_)});
    }

    bool has_hidden() const noexcept {
        for (int n = 0; n < static_cast<int>(bodies_->count()); ++n)
            if (now_->is_hidden(n)) return true;
        return false;
    }

    int partner_place() const noexcept {
        const double place = partner.connected ? partner.get() : -1.0;
        return place >= 0.0 && place < static_cast<double>(bodies_->count()) ? static_cast<int>(place) : -1;
    }

    /// The place that a parameter gives, or another one.
    int place_of(const Param& given, int otherwise) const noexcept {
        return given >= 0.0 && given < static_cast<double>(bodies_->count()) ? static_cast<int>(given) : otherwise;
    }

    bool edge(const In<bool>& button, std::size_t n) noexcept {
        const bool now = button.connected && button.get(), pressed = now && !was_[n];
        was_[n] = now;
        return pressed;
    }

    Vec3 middle_at(const Pose& pose) const noexcept { return pose.apply(bodies_->home(last_).position); }

    void publish() noexcept {
        scene = bodies_->scene();
        steps = static_cast<double>(history_->done());
        settled = settled_;
    }

    double wanted_alternative_ = -1.0, wanted_drop_ = -1.0;
    std::unique_ptr<CaseBodies> bodies_;
    std::unique_ptr<fit::Arrangement> now_;  // with what the hand has done since the last step
    std::unique_ptr<plan::PlanHistory> history_;
    std::int64_t given_ = 0;  // commands
    std::shared_ptr<StepKeeper> keeper_;
    RecordStream* stream_ = nullptr;
    std::string name_;
    int last_ = -1;
    Vec3 let_at_{0.0};  // middle of a body in the hand's pose when it was settled
    bool holding_ = false, settled_ = false, not_kept_ = false;
    bool was_[8] = {};
    Notice held_back_{"nothing is undone or redone while a fragment is held: let it go first"};
    Notice no_earlier_{"there is no step to undo"};
    Notice no_later_{"there is no step to redo"};
    Notice no_alternative_{
        "there is no such alternative to go to, to drop or to bring back; they have whole numbers from 0 on"};
    Notice no_fit_{"not settled: the held fragment has no fit where it is"};
};

TACTUS_NODE(CaseScene, moved, which, holding, target, fits, target_of, partner, score, margin, rms, gap, penetration,
            overlap, settle, join, split, lock, hide, show, undo, redo, scene, steps, settled, plan, file, loose,
            choose, with, alternative, drop)
TACTUS_VISUALS(CaseScene)

}  // namespace tactus::nodes
