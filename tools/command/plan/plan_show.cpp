// SPDX-License-Identifier: Apache-2.0
// tactus plan show: the content of a plan.
#include "assets/plan/plan_file.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/report/plan/plan_result.hpp"
#include "tools/report/result/printers.hpp"

namespace tactus::command {

int show_plan(const PlanChoice& choice) {
    check_plan_results(choice);
    const report::ShownPlan shown = report::ShownPlan::of(plan::load_case_plan(choice.plan), choice.plan.parent_path());
    write_result(report::plan_fields().of(shown), choice.result);
    return done;
}

Verb plan_show_verb() {
    return {.name = "show",
            .about = "show fragments, groups, alternatives, and problems of the files",
            .add = [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<PlanChoice>();
                add_plan_report_options(verb, *choice);
                return [choice] { return show_plan(*choice); };
            },
            .schema = [] { return report::schema_of_output({report::plan_fields().schema()}); }};
}

}  // namespace tactus::command
