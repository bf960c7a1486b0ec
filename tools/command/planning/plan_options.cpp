// SPDX-License-Identifier: Apache-2.0
#include "tools/command/planning/plan_options.hpp"

namespace tactus::command {

void add_plan_options(VerbOptions& verb, PlanChoice& choice) {
    verb.add("plan", choice.plan, "plan file, JSON").required();
    verb.flag("--json", choice.json, "as JSON");
}

void add_fit_options(VerbOptions& verb, PlanChoice& choice) {
    verb.add("--kerf", choice.kerf,
             "mm of bone that a blade or a break took away all along the faces; the fit leaves it open")
        .shows_default()
        .range(0.0, 4.0);
    verb.flag("--healthy", choice.with_healthy,
              "fit to the healthy side of 'plan mirror' too: it decides where the faces slide on each other");
}

study::FitWay fit_way(const PlanChoice& choice) { return {choice.kerf * 1e-3, choice.with_healthy}; }

Option add_fragments(VerbOptions& verb, PlanChoice& choice, const char* about) {
    return verb.add("fragments", choice.names, about).required();
}

int show_change(const PlanChoice& choice) {
    if (choice.json) return show_plan(choice);
    return done;
}

}  // namespace tactus::command
