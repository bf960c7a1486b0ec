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
    if (choice.json) return show_plan(choice);
    const plan::CasePlan plan = plan::load_case_plan(choice.plan);
    for (const plan::PlanAlternative& a : plan.alternatives)
        fmt::print("{} {}: {}\n", &a == &plan.alternatives[static_cast<std::size_t>(plan.current)] ? '*' : ' ', a.name,
                   counted(fit::steps_to(plan.before(), a.place.head).size(), "step"));
    return done;
}

int go_to_alternative(const AlternativeChoice& choice) {
    if (choice.alternative.empty()) return list_alternatives(choice);
    analysis::OpenPlan open(choice.plan);
    plan::CasePlan& plan = open.plan;
    const auto find = [&plan](const std::string& name) {
        return std::ranges::find(plan.alternatives, name, &plan::PlanAlternative::name);
    };
    auto found = find(choice.alternative);
    if (choice.remove) {
        if (found == plan.alternatives.end() || found - plan.alternatives.begin() == plan.current)
            throw Error(
                fmt::format("'{}' cannot be removed: {}", choice.alternative,
                            found == plan.alternatives.end() ? "it does not exist" : "it is the current alternative"));
        if (found - plan.alternatives.begin() < plan.current) --plan.current;
        plan.alternatives.erase(found);
    } else if (found == plan.alternatives.end()) {
        const auto from = choice.from.empty() ? plan.alternatives.begin() + plan.current : find(choice.from);
        if (from == plan.alternatives.end())
            throw Error(fmt::format("there is no alternative '{}' to begin from", choice.from));
        plan.alternatives.push_back({choice.alternative, fit::after_step(from->place.head)});
        plan.current = static_cast<int>(plan.alternatives.size()) - 1;
    } else if (!choice.from.empty()) {
        throw Error(
            fmt::format("the alternative '{}' exists already; leave out --from to switch to it", choice.alternative));
    } else plan.current = static_cast<int>(found - plan.alternatives.begin());
    plan::save_case_plan(plan, choice.plan);
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
