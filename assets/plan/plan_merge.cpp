// SPDX-License-Identifier: Apache-2.0
// A plan file holds a tree that only grows, so two versions are combined as the union of their trees. A textual merge
// could produce a plan that nobody made. An alternative that only one side has moved is moved on, as a fast-forward of git.
#include "assets/plan/plan_merge.hpp"

#include "assets/plan/plan_files.hpp"
#include "assets/plan/plan_history.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace tactus::plan {

namespace {

/// The content of a step, with fragments by name.
std::string text_of(const std::vector<PlanFragment>& fragments, PlanStep step) {
    CasePlan one;
    for (const PlanFragment& fragment : fragments) one.fragments.push_back({fragment.name, "", 0, {}});
    step.before = -1;
    one.steps.push_back(std::move(step));
    return content_of(std::move(one));
}

/// Numbers of the fragments of `other` in `plan`, which gets those that it lacks.
std::vector<int> add_fragments(CasePlan& plan, const CasePlan& other) {
    std::vector<int> numbers;
    for (const PlanFragment& fragment : other.fragments) {
        const auto same = std::ranges::find(plan.fragments, fragment.name, &PlanFragment::name);
        if (same != plan.fragments.end() && same->hash != fragment.hash)
            throw Error(fmt::format("the two plans have different files for the fragment '{}': {} and {}",
                                    fragment.name, same->file, fragment.file));
        numbers.push_back(static_cast<int>(same - plan.fragments.begin()));
        if (same == plan.fragments.end()) plan.fragments.push_back(fragment);
    }
    return numbers;
}

class Merge {
public:
    Merge(CasePlan& plan, const CasePlan& other) : plan_(plan), numbers_(add_fragments(plan, other)) {
        for (std::size_t n = 0; n < plan.steps.size(); ++n) {
            PlanStep& step = plan.steps[n];
            known_.emplace(std::pair(step.before, text_of(plan.fragments, step)), static_cast<int>(n));
        }
        known_count_ = static_cast<int>(plan.steps.size());
        for (const PlanStep& step : other.steps) steps_.push_back(add(step));
    }

    /// The position leads to a step that only the other plan had.
    bool is_new(fit::HistoryPlace place) const { return place.head >= known_count_; }

    /// A position among the steps of `other`, in `plan`.
    fit::HistoryPlace place(fit::HistoryPlace of_other) const {
        const auto number = [this](int n) { return n < 0 ? n : steps_[static_cast<std::size_t>(n)]; };
        return {number(of_other.head), number(of_other.tip)};
    }

private:
    int add(PlanStep step) {
        for (int& fragment : step.fragments) fragment = numbers_[static_cast<std::size_t>(fragment)];
        if (step.before >= 0) step.before = steps_[static_cast<std::size_t>(step.before)];
        const auto [known, is_new] = known_.emplace(std::pair(step.before, text_of(plan_.fragments, step)),
                                                    static_cast<int>(plan_.steps.size()));
        if (is_new) plan_.steps.push_back(std::move(step));
        return known->second;
    }

    CasePlan& plan_;
    std::vector<int> numbers_, steps_;  // of fragments and steps of the other plan, in this one
    int known_count_ = 0;
    std::map<std::pair<int, std::string>, int> known_;
};

bool is_same(fit::HistoryPlace a, fit::HistoryPlace b) { return a.head == b.head && a.tip == b.tip; }

/// Whether `later` goes on from the last step of `earlier`, which has nothing to redo: moving on loses nothing.
bool goes_on(const CasePlan& plan, fit::HistoryPlace earlier, fit::HistoryPlace later) {
    return earlier.head == earlier.tip && fit::is_on_way(plan.before(), earlier.head, later.head);
}

PlanAlternative* find_alternative(CasePlan& plan, const std::string& name) {
    const auto found = std::ranges::find(plan.alternatives, name, &PlanAlternative::name);
    return found == plan.alternatives.end() ? nullptr : &*found;
}

std::optional<fit::HistoryPlace> place_named(const CasePlan& plan, const std::string& name) {
    const auto found = std::ranges::find(plan.alternatives, name, &PlanAlternative::name);
    return found == plan.alternatives.end() ? std::nullopt : std::optional(found->place);
}

/// Moves an alternative of that name, or of an earlier merge ("main (2)"), on to `place`, or adds one.
void add_alternative(CasePlan& merged, const std::string& theirs, fit::HistoryPlace place, bool is_only_theirs,
                     MergedAlternatives& changed) {
    std::string name = theirs;
    for (int n = 2; PlanAlternative* known = find_alternative(merged, name); ++n) {
        if (is_same(known->place, place)) return;
        if ((n == 2 && is_only_theirs) || goes_on(merged, known->place, place)) {
            known->place = place;
            changed.forwarded.push_back(name);
            return;
        }
        name = fmt::format("{} ({})", theirs, n);
    }
    merged.alternatives.push_back({name, place});
    changed.added.push_back(std::move(name));
}

}  // namespace

MergedAlternatives merge(CasePlan& plan, const CasePlan& other, const CasePlan* base) {
    CasePlan merged = plan;
    const Merge into(merged, other);
    std::optional<Merge> from_base;
    if (base) from_base.emplace(merged, *base);
    MergedAlternatives changed;
    for (const PlanAlternative& theirs : other.alternatives) {
        const fit::HistoryPlace place = into.place(theirs.place);
        const auto mine = place_named(merged, theirs.name);
        bool is_only_theirs = false;
        if (base) {
            const auto named = place_named(*base, theirs.name);
            const auto before = named ? std::optional(from_base->place(*named)) : std::nullopt;
            // Unchanged there; here it was moved or dropped.
            if (before && is_same(*before, place)) continue;
            is_only_theirs = before && mine && is_same(*before, *mine);
        } else if (mine && !into.is_new(place)) continue;
        add_alternative(merged, theirs.name, place, is_only_theirs, changed);
    }
    if (!changed.added.empty() && merged.alternatives.size() > PlanHistory::max_alternatives)
        throw Error(
            fmt::format("the two plans have {} alternatives together, and a plan has at most {}: remove some "
                        "of either first ('tactus plan alternative')",
                        merged.alternatives.size(), PlanHistory::max_alternatives));
    // The combined tree must be as valid as its parts: a reconstruction hides the pieces of all others.
    visit_steps(merged, [](int, const PlanState&, const PlanState&) {});
    plan = std::move(merged);
    return changed;
}

}  // namespace tactus::plan
