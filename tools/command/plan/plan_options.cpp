// SPDX-License-Identifier: Apache-2.0
#include "tools/command/plan/plan_options.hpp"

#include <utility>

namespace tactus::command {

void add_plan_options(VerbOptions& verb, PlanChoice& choice) {
    verb.add("plan", choice.plan, "plan file, JSON").required();
    verb.flag("--json", choice.result.json, "as JSON");
}

void add_plan_report_options(VerbOptions& verb, PlanChoice& choice, Product product) {
    verb.add("plan", choice.plan, "plan file, JSON").required();
    add_result_options(verb, choice.result, ResultFigure::none, std::move(product));
}

void add_fit_options(VerbOptions& verb, PlanChoice& choice) {
    verb.add("--kerf", choice.kerf,
             "mm of bone that a blade or a break took away all along the faces; the fit leaves it open. 0: nothing is "
             "lost, and no kerf is looked for (default: a fit that the cortex shows open is refused)")
        .range(0.0, 4.0);
    verb.flag("--healthy", choice.with_healthy,
              "fit to the healthy side of 'plan mirror' too: it decides where the faces slide on each other");
}

analysis::FitWay fit_way(const PlanChoice& choice) {
    analysis::FitWay way{std::nullopt, choice.with_healthy};
    if (choice.kerf) way.kerf = *choice.kerf * 1e-3;
    return way;
}

Option add_fragments(VerbOptions& verb, PlanChoice& choice, const char* about) {
    return verb.add("fragments", choice.names, about).required();
}

int show_change(const PlanChoice& choice, bool is_changed) {
    if (choice.result.json) return show_plan(choice);
    if (!is_changed) fmt::print("the plan is already so\n");
    return done;
}

}  // namespace tactus::command
