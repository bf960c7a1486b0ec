// SPDX-License-Identifier: Apache-2.0
// tactus plan gap: gap, contact and overlap of placed fragments.
#include "assets/plan/plan_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/plan/plan_matching.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/report/plan/plan_result.hpp"
#include "tools/report/result/printers.hpp"

namespace tactus::command {

namespace {

int gap(const PlanChoice& choice) {
    check_plan_results(choice);
    const plan::CasePlan plan = plan::load_case_plan(choice.plan);
    if (!choice.names.empty() && (choice.names.size() != 2 || choice.names[0] == choice.names[1]))
        throw Error("'plan gap' needs two different fragments, or none");
    const std::filesystem::path folder = choice.plan.parent_path();
    std::optional<std::pair<int, int>> pair;
    if (!choice.names.empty())
        pair = {plan::find_fragment(plan, choice.names[0]), plan::find_fragment(plan, choice.names[1])};
    const std::vector<analysis::PlanGap> gaps = analysis::plan_gaps(plan, folder, pair);
    write_result(report::gaps_fields().of(report::named_gaps(plan, gaps)), choice.result);
    return done;
}

Action declare_plan_gap(VerbOptions& verb) {
    const auto choice = std::make_shared<PlanChoice>();
    add_plan_report_options(verb, *choice);
    verb.add("fragments", choice->names, "two fragments (default: all pairs that face each other)");
    return [choice] { return gap(*choice); };
}

}  // namespace

Verb plan_gap_verb() {
    return {.name = "gap",
            .about = "measure gap, contact and overlap of placed fragments",
            .add = declare_plan_gap,
            .schema = [] { return report::schema_of_output({report::gaps_fields().schema()}); }};
}

}  // namespace tactus::command
