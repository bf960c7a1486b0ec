// SPDX-License-Identifier: Apache-2.0
// tactus plan check: whether a plan is finished and does not contradict itself, by its warnings.
#include "assets/plan/plan_file.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/report/plan/plan_result.hpp"
#include "tools/report/result/printers.hpp"

#include <fmt/format.h>

namespace tactus::command {

namespace {

int check(const PlanChoice& choice) {
    check_plan_results(choice);
    const plan::CasePlan plan = plan::load_case_plan(choice.plan);
    const std::filesystem::path folder = choice.plan.parent_path();
    const report::ShownPlan checked{plan, plan::state_of(plan), analysis::case_warnings(plan, folder),
                                    analysis::deviation_from_target(plan, folder)};
    for (const std::string& note : checked.warnings.notes) fmt::print(stderr, "note: {}\n", note);
    write_result(report::checked_plan_fields().of(checked), choice.result);
    return checked.warnings.has_fault() ? answer_is_no : done;
}

Action declare_plan_check(VerbOptions& verb) {
    const auto choice = std::make_shared<PlanChoice>();
    add_plan_report_options(verb, *choice);
    return [choice] { return check(*choice); };
}

}  // namespace

Verb plan_check_verb() {
    return {
        .name = "check",
        .about =
            "check that fits or decisions connect all shown fragments, that the pieces of a reconstruction are where "
            "they are planned, and that none lies in another; 1: it is not so",
        .add = declare_plan_check,
        .schema = [] { return report::schema_of_output({report::checked_plan_fields().schema()}); }};
}

}  // namespace tactus::command
