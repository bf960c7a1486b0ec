// SPDX-License-Identifier: Apache-2.0
// tactus plan cuts: the cuts of a reconstruction, as planned or as its pieces were placed.
#include "tools/analysis/plan/plan_cuts.hpp"
#include "assets/plan/plan_file.hpp"
#include "tools/analysis/plan/flap_study.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/report/reconstruction/fibula_result.hpp"
#include "tools/report/result/printers.hpp"

namespace tactus::command {

namespace {

struct CutsChoice : PlanChoice {
    bool from_pieces = false;
    std::string alternative = "from-pieces";
};

int list_cuts(const CutsChoice& choice) {
    const plan::CasePlan plan = plan::load_case_plan(choice.plan);
    const analysis::FlapStudy study(plan, plan::state_of(plan), choice.plan.parent_path());
    write_result(report::fibula_fields().of({&study.inputs(), &study.fibula()}), choice.result);
    return done;
}

int derive_cuts(const CutsChoice& choice) {
    check_plan_results(choice);
    if (!choice.from_pieces) return list_cuts(choice);
    const analysis::CutsOfPieces found = analysis::cut_as_placed(choice.plan, choice.alternative);
    write_result(report::derived_cuts_fields().of({choice.plan.string(), choice.alternative, &found}), choice.result);
    return done;
}

Action declare_plan_cuts(VerbOptions& verb) {
    const auto choice = std::make_shared<CutsChoice>();
    add_plan_report_options(verb, *choice);
    verb.flag("--from-pieces", choice->from_pieces,
              "derive the cuts from where the segments are placed, and cut new pieces there");
    verb.add("--alternative", choice->alternative, "with --from-pieces: name of the alternative that the plan gets")
        .shows_default();
    return [choice] { return derive_cuts(*choice); };
}

}  // namespace

Verb plan_cuts_verb() {
    return {
        .name = "cuts",
        .about = "list the cuts of a reconstruction, or derive them from where its segments were placed by hand",
        .add = declare_plan_cuts,
        .schema = [] {
            return report::schema_of_output({report::fibula_fields().schema(), report::derived_cuts_fields().schema()});
        }};
}

}  // namespace tactus::command
