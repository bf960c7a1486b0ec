// SPDX-License-Identifier: Apache-2.0
// tactus plan alternative: named branches of a plan's history.
#include "dsp/core/error.hpp"
#include "tools/analysis/plan/plan_case.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/counted.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::command {

namespace {

struct AlternativeChoice : PlanChoice {
    std::string alternative, from;
    bool remove = false;
};

int list_alternatives(const PlanChoice& choice) {
    if (choice.result.json) return show_plan(choice);
    const plan::CasePlan plan = plan::load_case_plan(choice.plan);
    for (const plan::PlanAlternative& a : plan.alternatives)
        fmt::print("{} {}: {}\n", &a == &plan.alternatives[static_cast<std::size_t>(plan.current)] ? '*' : ' ', a.name,
                   counted(fit::steps_to(plan.before(), a.place.head).size(), "step"));
    return done;
}

int go_to_alternative(const AlternativeChoice& choice) {
    if (choice.alternative.empty()) return list_alternatives(choice);
    const analysis::OpenPlan open(choice.plan);
    plan::ChangedPlan changed(open.plan);
    const auto find = [&changed](const std::string& name) {
        const std::vector<plan::PlanAlternative>& all = changed.plan().alternatives;
        return static_cast<int>(std::ranges::find(all, name, &plan::PlanAlternative::name) - all.begin());
    };
    const auto apply = [&changed](const plan::PlanCommand& command, const std::string& name = {}) {
        using Outcome = plan::PlanHistory::Outcome;
        const Outcome outcome = changed.apply(command, {.name = name});
        if (outcome != Outcome::done && outcome != Outcome::unchanged) throw Error(std::string(plan::text_of(outcome)));
    };
    const int found = find(choice.alternative), count = static_cast<int>(open.plan.alternatives.size());
    if (choice.remove) {
        if (found == count || found == open.plan.current)
            throw Error(fmt::format("'{}' cannot be removed: {}", choice.alternative,
                                    found == count ? "it does not exist" : "it is the current alternative"));
        apply(plan::DropAlternative{found});
    } else if (found == count) {
        if (!choice.from.empty()) {
            if (find(choice.from) == count)
                throw Error(fmt::format("there is no alternative '{}' to begin from", choice.from));
            apply(plan::GoToAlternative{find(choice.from)});
        }
        apply(plan::GoToAlternative{count}, choice.alternative);
    } else if (!choice.from.empty()) {
        throw Error(
            fmt::format("the alternative '{}' exists already; leave out --from to switch to it", choice.alternative));
    } else apply(plan::GoToAlternative{found});
    plan::save_case_plan(changed.plan(), choice.plan);
    return show_change(choice);
}

Action declare_plan_alternative(VerbOptions& verb) {
    const auto choice = std::make_shared<AlternativeChoice>();
    add_plan_options(verb, *choice);
    verb.add("name", choice->alternative, "name of the alternative (default: list all)");
    verb.add("--from", choice->from, "begin it at the state of this alternative");
    verb.flag("--remove", choice->remove, "remove the name; its steps stay in the file");
    return [choice] { return go_to_alternative(*choice); };
}

}  // namespace

Verb plan_alternative_verb() {
    return {"alternative", "begin an alternative at the current state, or switch to another", declare_plan_alternative};
}

}  // namespace tactus::command
