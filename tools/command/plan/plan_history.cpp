// SPDX-License-Identifier: Apache-2.0
// tactus plan undo and redo.
#include "tools/analysis/plan/plan_case.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/counted.hpp"

#include <fmt/format.h>

namespace tactus::command {

namespace {

struct HistoryChoice : PlanChoice {
    int steps = 1;
};

int go(const HistoryChoice& choice, fit::HistoryPlace (*way)(std::span<const int>, fit::HistoryPlace),
       const char* end) {
    analysis::OpenPlan open(choice.plan);
    plan::CasePlan& plan = open.plan;
    const auto before = plan.before();
    int moved = 0;
    for (; moved < choice.steps; ++moved) {
        const fit::HistoryPlace next = way(before, plan.place());
        if (next.head == plan.place().head) break;
        plan.place() = next;
    }
    if (moved > 0) plan::save_case_plan(plan, choice.plan);
    if (!choice.json) {
        if (moved == 0) fmt::print("{}\n", end);
        else
            fmt::print("{}; {} of {} are done\n", counted(moved, "step"),
                       fit::steps_to(before, plan.place().head).size(), fit::steps_to(before, plan.place().tip).size());
    }
    show_change(choice);
    return moved > 0 ? done : answer_is_no;
}

std::shared_ptr<HistoryChoice> choice_of(VerbOptions& verb) {
    auto choice = std::make_shared<HistoryChoice>();
    add_plan_options(verb, *choice);
    verb.add("--steps", choice->steps, "how many").positive();
    return choice;
}

}  // namespace

Verb plan_undo_verb() {
    return {"undo", "undo steps; they stay in the plan", [](VerbOptions& verb) -> Action {
                return [choice = choice_of(verb)] { return go(*choice, fit::undone, "there is nothing to undo"); };
            }};
}

Verb plan_redo_verb() {
    return {"redo", "redo steps", [](VerbOptions& verb) -> Action {
                return [choice = choice_of(verb)] { return go(*choice, fit::redone, "there is nothing to redo"); };
            }};
}

}  // namespace tactus::command
