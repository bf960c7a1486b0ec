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

int go(const HistoryChoice& choice, const plan::PlanCommand& command) {
    using Outcome = plan::PlanHistory::Outcome;
    const analysis::OpenPlan open(choice.plan);
    plan::ChangedPlan changed(open.plan);
    const plan::CasePlan& plan = changed.plan();
    int moved = 0;
    Outcome outcome = Outcome::done;
    while (moved < choice.steps && (outcome = changed.apply(command)) == Outcome::done) ++moved;
    if (moved > 0) plan::save_case_plan(plan, choice.plan);
    const auto before = plan.before();
    if (!choice.result.json) {
        if (moved == 0) fmt::print("{}\n", plan::text_of(outcome));
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
                return [choice = choice_of(verb)] { return go(*choice, plan::UndoStep{}); };
            }};
}

Verb plan_redo_verb() {
    return {"redo", "redo steps", [](VerbOptions& verb) -> Action {
                return [choice = choice_of(verb)] { return go(*choice, plan::RedoStep{}); };
            }};
}

}  // namespace tactus::command
