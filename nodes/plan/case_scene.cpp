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
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::nodes {

/// The port of commands from outside, such as those of a window: parameters, so that a take and a log have them. The
/// numbers of a command are set first, and its serial number last.
class CommandPort {
public:
    Param number{as_trigger, "0", "0", "1000000000",
                 "changed: the command is done once; set it last, to the output 'received' plus 1"};

    void each(MemberVisitor& visitor) {
        for (std::size_t n = 0; n < params_.size(); ++n) visitor.param(plan::plan_command_port[n].name, params_[n]);
        visitor.param("command_number", number);
    }
    plan::PlanCommandNumbers numbers() const noexcept {
        plan::PlanCommandNumbers now;
        std::ranges::copy(params_, now.begin());
        return now;
    }

private:
    static constexpr std::size_t count = plan::plan_command_port.size();
    template <std::size_t... n>
    static std::array<Param, count> made(std::index_sequence<n...>) {
        constexpr const auto& port = plan::plan_command_port;
        return {{Param(as_trigger, port[n].start, port[n].least, port[n].most, port[n].about)...}};
    }

    std::array<Param, count> params_ = made(std::make_index_sequence<count>());
};
static_assert(tactus::coupling::Scene::max_objects <= plan::max_port_fragments);

struct CaseScene {
    static constexpr auto about =
        "The fragments of a plan as one scene. The held fragment and its group follow the coupling. Releasing, "
        "settling, joining, splitting, locking and hiding are steps that can be undone, as are the steps already in "
        "the plan. Every step is written to the plan's file soon after it is done. A command from outside that would "
        "move what a hand holds or touches first asks for its release.";

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
    Out<double> received{"number of the last command from outside that was done or refused"};
    Out<bool> release{"a command waits until the held body is released: for grasp.release"};
    Asset<plan::CaseBones> plan{"the plan with its fragments; new steps follow its current one"};
    Text file{"case.plan.json", "name of the plan file with the steps of the run, in the run folder; empty: none"};
    Param loose{"8 mm", "0.1 mm", "100 mm",
                "a settled body is free again when the hand moves it farther than this from where it settled"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::scene, .value = "scene", .asset = "plan"},
                {.kind = VisualKind::asset_bone, .value = "scene", .asset = "plan"}};
    }

    CommandPort port;

    void prepare(const Setup& setup) {
        if (plan->bones.size() > tactus::coupling::Scene::max_objects)
            setup.fail("plan '" + plan.name +
                       "' has more than 16 fragments; hiding does not help: plan the case in parts");
        name_ = setup.name;
        for (Notice* notice : {&held_back_, &no_earlier_, &no_later_, &no_fit_, &no_alternative_, &locked_,
                               &no_fragment_, &no_command_, &not_released_})
            notice->attach(setup);
        bodies_ = std::make_unique<CaseBodies>(plan->bones);
        if (plan->plan.alternatives.size() > plan::PlanHistory::max_alternatives)
            setup.fail("plan '" + plan.name +
                       "' has more than 32 alternatives; remove some: 'tactus plan alternative'");
        history_ = std::make_unique<plan::PlanHistory>(plan->plan);
        now_ = std::make_unique<fit::Arrangement>(history_->now());
        given_ = 0;
        received_ = 0.0;
        arrived_.reset();
        command_.reset();
        waits_since_ = -1;
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
        receive(tick);
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
        if (settles && has_fit() && moved.connected && is_valid(moved.get()) &&
            give(tick, settling()) == plan::PlanHistory::Outcome::done) {
            settled_ = true;
            let_at_ = middle_at(file_pose(last_, {moved->position, glm::normalize(moved->orientation)}));
        }
        const int meant = last_;
        if (edge(join, 1) && meant >= 0) {
            const int other = partner_place();
            keep_held(tick);
            if (other >= 0) give(tick, plan::JoinFragments{plan::set_of({meant, other})});
        }
        if (edge(split, 2) && meant >= 0) {
            keep_held(tick);
            give(tick, plan::SplitFragments{plan::set_of({meant})});
        }
        if (edge(lock, 3) && meant >= 0) {
            keep_held(tick);
            give(tick, plan::LockFragments{plan::set_of({meant}), !now_->is_locked(meant)});
        }
        if (edge(hide, 6) && meant >= 0 && !now_->is_hidden(meant)) {
            keep_held(tick);
            give(tick, plan::HideFragments{plan::set_of({meant})});
        }
        if (edge(show, 7) && hidden().any()) {
            keep_held(tick);
            give(tick, plan::HideFragments{hidden(), false});
        }
        const bool back = edge(undo, 4), on = edge(redo, 5);
        if ((back || on) && holding_) held_back_.tell();
        else if (back) notify(give(tick, plan::UndoStep{}));
        else if (on) notify(give(tick, plan::RedoStep{}));
    }

    /// Does the command at the port once. One that may change the force on a hand waits until the hand has released its
    /// body and its force has faded.
    void receive(const Tick& tick) noexcept {
        // A command that waits is the one that came: the port may hold the next one by then.
        if (!arrived_ && port.number != received_ && port.number > 0.0) {
            arrived_ = port.number;
            command_ = plan::command_of(port.numbers());
        }
        const bool is_new = arrived_.has_value();
        const std::optional<plan::PlanCommand>& command = command_;
        // Also while the force fades: the pull of a vessel would follow the scene meanwhile.
        const bool fades = !holding_ && held() >= 0;
        if (command && (holding_ || fades) && may_be_felt(*command)) {
            if (waits_since_ < 0 || fades != waits_for_fade_) waits_since_ = tick.index;
            waits_for_fade_ = fades;
            const double longest = fades ? faded_within_s : release_within_s;
            if (seconds((tick.index - waits_since_) * tick.period) < longest) return;
            not_released_.tell();
        } else if (command) {
            const std::optional<Pose> in_hand = holding_ ? std::optional(now_->pose(last_)) : std::nullopt;
            notify(give(tick, *command));
            // Where the hand is now is no step yet, and stays.
            if (in_hand && now_->move(last_, *in_hand)) bodies_->show_unit(*now_, last_);
        } else if (is_new) no_command_.tell();
        if (is_new) received_ = *arrived_;
        arrived_.reset();
        command_.reset();
        waits_since_ = -1;
    }

    /// Whether a command may move or uncover what the held body touches.
    bool may_be_felt(const plan::PlanCommand& command) const noexcept {
        const auto has_held = [this](const plan::FragmentSet& fragments) {
            for (int n = 0; n < static_cast<int>(bodies_->count()); ++n)
                if (fragments[static_cast<std::size_t>(n)] && now_->move_together(n, last_)) return true;
            return false;
        };
        if (const auto* joined = std::get_if<plan::JoinFragments>(&command)) return has_held(joined->fragments);
        if (const auto* split = std::get_if<plan::SplitFragments>(&command)) return has_held(split->fragments);
        if (const auto* lock = std::get_if<plan::LockFragments>(&command)) return has_held(lock->fragments);
        return true;
    }

    /// Applies a command to the plan, shows the result and records it. If the outcome is not `done`, it changed nothing.
    plan::PlanHistory::Outcome give(const Tick& tick, const plan::PlanCommand& command) noexcept {
        const plan::PlanHistory::Outcome outcome = history_->apply(command);
        // What the hand has moved since the last step is part of the command, or void.
        *now_ = history_->now();
        bodies_->arrange(*now_);
        if (outcome != plan::PlanHistory::Outcome::done) return outcome;
        const plan::PlanRecord record{given_++, command};
        if (stream_ && !stream_->write(tick.index, &record, 1, sizeof record)) not_kept_ = true;
        return outcome;
    }

    /// Why a command was not done.
    void notify(plan::PlanHistory::Outcome outcome) noexcept {
        using enum plan::PlanHistory::Outcome;
        switch (outcome) {
            case done:
            case unchanged: break;
            case locked: locked_.tell(); break;
            case no_such_fragment:
            case no_such_group:
            case too_far: no_fragment_.tell(); break;
            case nothing_to_undo: no_earlier_.tell(); break;
            case nothing_to_redo: no_later_.tell(); break;
            case no_such_alternative:
            case too_many_alternatives: no_alternative_.tell(); break;
        }
    }

    plan::SettleFragment settling() const noexcept {
        const auto figure = [](const In<double>& of) { return of.connected ? of.get() : 0.0; };
        return {last_,
                partner_place(),
                file_pose(last_, {target->position, glm::normalize(target->orientation)}),
                {figure(score), figure(margin), figure(rms), figure(gap), figure(penetration), figure(overlap)}};
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

    plan::FragmentSet hidden() const noexcept {
        plan::FragmentSet all;
        for (int n = 0; n < static_cast<int>(bodies_->count()); ++n)
            all[static_cast<std::size_t>(n)] = now_->is_hidden(n);
        return all;
    }

    int partner_place() const noexcept {
        const double place = partner.connected ? partner.get() : -1.0;
        return place >= 0.0 && place < static_cast<double>(bodies_->count()) ? static_cast<int>(place) : -1;
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
        received = received_;
        release = waits_since_ >= 0;
    }

    static constexpr double release_within_s = 0.25;  // a patch without the wire to grasp never releases
    static constexpr double faded_within_s = 10.5;  // more than the longest fade of grasp
    double received_ = 0.0;
    std::optional<double> arrived_;  // number of the command that is done or waits
    std::optional<plan::PlanCommand> command_;
    bool waits_for_fade_ = false;
    std::int64_t waits_since_ = -1;  // tick from which on a command waits for the release; -1: none does
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
    Notice no_alternative_{"there is no such alternative to go to, to drop or to bring back, or there are 32 already"};
    Notice locked_{"nothing was moved: the fragment, or one of its group, is locked"};
    Notice no_fragment_{
        "a command from outside names a fragment or a group that is not there, or a pose that is not possible"};
    Notice no_command_{"a command from outside has no such kind, or names no whole number of a fragment"};
    Notice not_released_{
        "a command was not done, because a hand holds a fragment and does not release it: let it go first, or wire "
        "'release' of the case to 'release' of the grasp"};
    Notice no_fit_{"not settled: the held fragment has no fit where it is"};
};

TACTUS_NODE(CaseScene, moved, which, holding, target, fits, target_of, partner, score, margin, rms, gap, penetration,
            overlap, settle, join, split, lock, hide, show, undo, redo, scene, steps, settled, received, release, plan,
            file, loose, port)
TACTUS_VISUALS(CaseScene)

}  // namespace tactus::nodes
