// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/plan_history.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/fit/fit.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

namespace tactus::plan {

namespace {

// Nine hours at a step per second. Later steps are kept too, but the oldest can then no longer be undone.
constexpr std::size_t max_steps = 32768;

std::string verdict_of_basis(FitBasis basis) {
    switch (basis) {
        case FitBasis::fracture: return std::string(fit::name_of(fit::FitVerdict::fit));
        case FitBasis::hand: return "accepted by hand";
        case FitBasis::mirror: return "accepted by mirror";
        case FitBasis::plan: return "accepted by plan";
    }
    return {};
}

template <class Each>
void for_each(const FragmentSet& fragments, const Each& each) {
    for (std::size_t n = 0; n < fragments.size(); ++n)
        if (fragments[n]) each(static_cast<int>(n));
}

/// Applies `change` to each fragment. Returns those that it changed, which the step then names.
template <class Change>
FragmentSet changed_by(const FragmentSet& fragments, const Change& change) noexcept {
    FragmentSet changed;
    for_each(fragments, [&](int n) { changed[static_cast<std::size_t>(n)] = change(n); });
    return changed;
}

FragmentSet applied(fit::Arrangement& to, const JoinFragments& c) noexcept {
    std::array<int, max_fragments> all;
    std::size_t count = 0;
    for_each(c.fragments, [&](int n) { all[count++] = n; });
    return to.join(std::span(all.data(), count)) != fit::Arrangement::none ? c.fragments : FragmentSet();
}
FragmentSet applied(fit::Arrangement& to, const AddFragments& c) noexcept {
    return changed_by(c.fragments, [&](int n) { return to.add(c.group, n); });
}
FragmentSet applied(fit::Arrangement& to, const SplitFragments& c) noexcept {
    return changed_by(c.fragments, [&](int n) { return to.remove(n); });
}
FragmentSet applied(fit::Arrangement& to, const LockFragments& c) noexcept {
    return changed_by(c.fragments, [&](int n) {
        const bool is_change = to.is_locked(n) != c.is_locked;
        to.lock(n, c.is_locked);
        return is_change;
    });
}
FragmentSet applied(fit::Arrangement& to, const HideFragments& c) noexcept {
    return changed_by(c.fragments, [&](int n) {
        const bool is_change = to.is_hidden(n) != c.is_hidden;
        to.hide(n, c.is_hidden);
        return is_change;
    });
}

}  // namespace

PlanHistory::PlanHistory(const CasePlan& plan)
    : tree_(plan.fragments.size(), plan.steps.size(), max_steps),
      now_(state_of(plan).arrangement),
      before_(now_),
      alternative_(static_cast<std::size_t>(plan.current)) {
    visit_steps(plan, [&](int n, const PlanState& from, const PlanState& to) {
        tree_.put(n, plan.steps[static_cast<std::size_t>(n)].before, from.arrangement, to.arrangement);
    });
    tree_.stand(plan.place());
    alternatives_.reserve(std::max(max_alternatives, plan.alternatives.size()));
    dropped_.reserve(max_dropped);
    for (const PlanAlternative& alternative : plan.alternatives) alternatives_.push_back(alternative.place);
}

struct PlanHistory::Apply {
    PlanHistory& to;

    Outcome move(int fragment, const Pose& pose) const noexcept {
        if (!to.has(fragment) || !is_valid(pose)) return Outcome::no_such_fragment;
        if (!to.now_.move(fragment, pose)) return Outcome::locked;
        for (int n = 0; n < static_cast<int>(to.now_.size()); ++n)
            if (to.now_.move_together(fragment, n) && !is_near(to.now_.pose(n))) return Outcome::too_far;
        return Outcome::done;
    }
    template <class OfFragments>
    Outcome change(const OfFragments& c) const noexcept {
        if ((c.fragments >> to.now_.size()).any() || c.fragments.none()) return Outcome::no_such_fragment;
        return applied(to.now_, c).any() ? to.add_step() : Outcome::unchanged;
    }

    Outcome operator()(const PlaceFragment& c) const noexcept {
        if (const Outcome moved = move(c.fragment, c.pose); moved != Outcome::done) return moved;
        const Pose &was = to.before_.pose(c.fragment), &is = to.now_.pose(c.fragment);
        const bool is_near = glm::length(is.position - was.position) < min_distance &&
                             glm::length(rotation_between(was.orientation, is.orientation)) < min_angle;
        return is_near ? Outcome::unchanged : to.add_step();
    }
    Outcome operator()(const SettleFragment& c) const noexcept {
        if (c.partner >= 0 && (!to.has(c.partner) || c.partner == c.fragment)) return Outcome::no_such_fragment;
        if (const Outcome moved = move(c.fragment, c.pose); moved != Outcome::done) return moved;
        to.now_.fit(c.fragment, c.partner);
        return to.add_step();
    }
    Outcome operator()(const JoinFragments& c) const noexcept { return change(c); }
    Outcome operator()(const AddFragments& c) const noexcept {
        return to.now_.exists(c.group) ? change(c) : Outcome::no_such_group;
    }
    Outcome operator()(const SplitFragments& c) const noexcept { return change(c); }
    Outcome operator()(const DissolveGroup& c) const noexcept {
        return to.now_.dissolve(c.group) ? to.add_step() : Outcome::no_such_group;
    }
    Outcome operator()(const LockFragments& c) const noexcept { return change(c); }
    Outcome operator()(const HideFragments& c) const noexcept { return change(c); }
    Outcome operator()(const UndoStep&) const noexcept {
        return to.tree_.undo(to.now_) ? Outcome::done : Outcome::nothing_to_undo;
    }
    Outcome operator()(const RedoStep&) const noexcept {
        return to.tree_.redo(to.now_) ? Outcome::done : Outcome::nothing_to_redo;
    }
    Outcome operator()(const GoToAlternative& c) const noexcept {
        return c.alternative < 0 ? Outcome::no_such_alternative : to.go_to(static_cast<std::size_t>(c.alternative));
    }
    Outcome operator()(const DropAlternative& c) const noexcept {
        return c.alternative < 0 ? Outcome::no_such_alternative : to.drop(static_cast<std::size_t>(c.alternative));
    }
    Outcome operator()(const RestoreAlternative&) const noexcept { return to.restore(); }
};

PlanHistory::Outcome PlanHistory::apply(const PlanCommand& command) noexcept {
    before_ = now_;
    const Outcome outcome = std::visit(Apply{*this}, command);
    if (outcome != Outcome::done) now_ = before_;
    return outcome;
}

PlanHistory::Outcome PlanHistory::add_step() noexcept {
    tree_.add(before_, now_);
    return Outcome::done;
}

PlanHistory::Outcome PlanHistory::go_to(std::size_t alternative) noexcept {
    const bool begins = alternative == alternatives_.size();
    if (alternative > alternatives_.size()) return Outcome::no_such_alternative;
    if (begins && alternatives_.size() >= max_alternatives) return Outcome::too_many_alternatives;
    if (alternative == alternative_) return Outcome::unchanged;
    alternatives_[alternative_] = tree_.place();
    if (begins) alternatives_.push_back(fit::after_step(tree_.head()));
    // A step that is so old that the run does not store it any more.
    if (!tree_.go(alternatives_[alternative], now_)) {
        if (begins) alternatives_.pop_back();
        return Outcome::no_such_alternative;
    }
    alternative_ = alternative;
    return Outcome::done;
}

PlanHistory::Outcome PlanHistory::drop(std::size_t alternative) noexcept {
    if (alternative >= alternatives_.size() || alternative == alternative_) return Outcome::no_such_alternative;
    if (dropped_.size() == max_dropped) dropped_.erase(dropped_.begin());
    dropped_.push_back(alternatives_[alternative]);
    alternatives_.erase(alternatives_.begin() + static_cast<std::ptrdiff_t>(alternative));
    alternative_ -= alternative < alternative_ ? 1 : 0;
    return Outcome::done;
}

PlanHistory::Outcome PlanHistory::restore() noexcept {
    if (dropped_.empty()) return Outcome::no_such_alternative;
    if (alternatives_.size() >= max_alternatives) return Outcome::too_many_alternatives;
    alternatives_.push_back(dropped_.back());
    dropped_.pop_back();
    return Outcome::done;
}

std::string_view text_of(PlanHistory::Outcome outcome) {
    using enum PlanHistory::Outcome;
    switch (outcome) {
        case done: return "done";
        case unchanged: return "the plan is already so";
        case locked: return "the fragment, or one of its group, is locked";
        case no_such_fragment: return "there is no such fragment, or its pose is not valid";
        case too_far: return "a fragment would lie more than 100 m away; are the numbers in mm?";
        case no_such_group: return "there is no such group";
        case nothing_to_undo: return "there is no step to undo";
        case nothing_to_redo: return "there is no step to redo";
        case no_such_alternative: return "there is no such alternative to go to, to drop or to bring back";
        case too_many_alternatives: return "a plan has at most 32 alternatives: remove one first";
    }
    return {};
}

ChangedPlan::ChangedPlan(CasePlan plan) : plan_(std::move(plan)), state_(state_of(plan_)), history_(plan_) {}

/// "alternative 2", or the next free number; those of alternatives that may come back are not free.
std::string ChangedPlan::free_name() const {
    const auto has = [](const std::vector<PlanAlternative>& some, const std::string& name) {
        return std::ranges::find(some, name, &PlanAlternative::name) != some.end();
    };
    for (std::size_t n = plan_.alternatives.size() + 1;; ++n)
        if (std::string name = fmt::format("alternative {}", n); !has(dropped_, name) && !has(plan_.alternatives, name))
            return name;
}

PlanStep ChangedPlan::step_of(const PlanCommand& command, const fit::Arrangement& before,
                              const std::string& name) const {
    PlanStep step;
    const auto place = [&](int fragment) {
        const fit::Arrangement& now = history_.now();
        step.kind = StepKind::place;
        step.fragments.push_back(fragment);
        for (int n = 0; n < static_cast<int>(now.size()); ++n)
            if (n != fragment && now.move_together(fragment, n)) step.fragments.push_back(n);
        for (const int n : step.fragments) step.poses.push_back(now.pose(n));
    };
    const auto of_fragments = [&](StepKind kind, const auto& c) {
        fit::Arrangement then = before;
        step.kind = kind;
        for_each(applied(then, c), [&](int n) { step.fragments.push_back(n); });
    };
    const auto group_name = [&](int group) { return state_.group_names[static_cast<std::size_t>(group)]; };
    if (const auto* placed = std::get_if<PlaceFragment>(&command)) place(placed->fragment);
    else if (const auto* settled = std::get_if<SettleFragment>(&command)) {
        place(settled->fragment);
        const FitNumbers& fit = settled->fit;
        if (settled->partner >= 0)
            step.fit = PlanFit{plan_.fragments[static_cast<std::size_t>(settled->partner)].name,
                               verdict_of_basis(settled->basis),
                               fit.score,
                               fit.margin,
                               fit.rms,
                               fit.gap,
                               fit.penetration,
                               fit.overlap};
    } else if (const auto* joined = std::get_if<JoinFragments>(&command)) {
        of_fragments(StepKind::group, *joined);
        step.group = name.empty() ? free_group_name(state_) : name;
    } else if (const auto* added = std::get_if<AddFragments>(&command)) {
        of_fragments(StepKind::add, *added);
        step.group = group_name(added->group);
    } else if (const auto* split = std::get_if<SplitFragments>(&command)) of_fragments(StepKind::remove, *split);
    else if (const auto* dissolved = std::get_if<DissolveGroup>(&command)) {
        step.kind = StepKind::ungroup;
        step.group = group_name(dissolved->group);
    } else if (const auto* lock = std::get_if<LockFragments>(&command))
        of_fragments(lock->is_locked ? StepKind::lock : StepKind::unlock, *lock);
    else if (const auto* hide = std::get_if<HideFragments>(&command))
        of_fragments(hide->is_hidden ? StepKind::hide : StepKind::show, *hide);
    return step;
}

void ChangedPlan::follow_alternatives(const PlanCommand& command, const std::string& name) {
    if (std::holds_alternative<GoToAlternative>(command)) {
        if (history_.alternatives() > plan_.alternatives.size())
            plan_.alternatives.push_back({name.empty() ? free_name() : name, history_.place()});
        plan_.current = static_cast<int>(history_.alternative());
    } else if (const auto* drop = std::get_if<DropAlternative>(&command)) {
        if (dropped_.size() == PlanHistory::max_dropped) dropped_.erase(dropped_.begin());
        dropped_.push_back(plan_.alternatives[static_cast<std::size_t>(drop->alternative)]);
        plan_.alternatives.erase(plan_.alternatives.begin() + drop->alternative);
        plan_.current = static_cast<int>(history_.alternative());
    } else if (std::holds_alternative<RestoreAlternative>(command)) {
        plan_.alternatives.push_back(std::move(dropped_.back()));
        dropped_.pop_back();
    }
    plan_.place() = history_.place();
    state_ = state_of(plan_);
}

PlanHistory::Outcome ChangedPlan::apply(const PlanCommand& command, const StepWords& words) {
    if (std::holds_alternative<GoToAlternative>(command) &&
        std::ranges::find(plan_.alternatives, words.name, &PlanAlternative::name) != plan_.alternatives.end())
        throw Error(fmt::format("the alternative '{}' exists already", words.name));
    const int count = history_.count();
    const fit::Arrangement before = history_.now();
    const PlanHistory::Outcome outcome = history_.apply(command);
    if (outcome != PlanHistory::Outcome::done) return outcome;
    if (history_.count() == count) {
        follow_alternatives(command, words.name);
        return outcome;
    }
    const auto* const settled = std::get_if<SettleFragment>(&command);
    PlanStep step = step_of(command, before, words.name);
    step.by = !words.by.empty() ? words.by : settled && settled->basis == FitBasis::fracture ? "settle" : "hand";
    step.time = words.time;
    step.run_second = words.run_second;
    try {
        plan::add_step(plan_, state_, std::move(step));
    } catch (const Error&) {
        history_ = PlanHistory(plan_);
        throw;
    }
    return outcome;
}

PlanHistory::Outcome change(CasePlan& plan, const PlanCommand& command, const StepWords& words) {
    ChangedPlan changed(plan);
    const PlanHistory::Outcome outcome = changed.apply(command, words);
    if (outcome == PlanHistory::Outcome::done) plan = changed.plan();
    return outcome;
}

}  // namespace tactus::plan
