// SPDX-License-Identifier: Apache-2.0
// tactus plan reach: whether the vessels of a flap reach, what comes near to what, and which way is best.
#include "assets/plan/plan_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/plan/flap_candidate.hpp"
#include "tools/analysis/plan/flap_study.hpp"
#include "tools/analysis/plan/flap_words.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/report/plan/plan_result.hpp"
#include "tools/report/reconstruction/flap_result.hpp"
#include "tools/report/result/printers.hpp"

#include <fmt/format.h>

#include <string>

namespace tactus::command {

namespace {

struct ReachChoice : PlanChoice {
    bool rank = false;
    int take = 0;
    std::string alternative;
};

int take(const ReachChoice& choice) {
    if (!choice.result.out.empty())
        throw Error("--take makes an alternative of the plan and measures nothing to write; give -o without it");
    const std::string name = choice.alternative.empty() ? fmt::format("candidate-{}", choice.take) : choice.alternative;
    const analysis::TakenCandidate taken =
        analysis::take_candidate(choice.plan, static_cast<std::size_t>(choice.take), name);
    if (choice.result.quiet) return done;
    if (choice.result.json) return show_change(choice);
    fmt::print("{}: alternative '{}': {}\n", choice.plan.string(), name, analysis::candidate_words(taken.candidate));
    for (const analysis::CaseWarning& w : analysis::warnings_of(taken.candidate.plan, taken.candidate.measures))
        fmt::print("warning: {}\n", w.text);
    fmt::print("for research, not a medical device\n");
    return done;
}

int reach(const ReachChoice& choice) {
    check_plan_results(choice);
    if (choice.take > 0) return take(choice);
    if (!choice.alternative.empty()) throw Error("--alternative names what --take makes; give --take N, too");
    const plan::CasePlan plan = plan::load_case_plan(choice.plan);
    analysis::FlapStudy study(plan, plan::state_of(plan), choice.plan.parent_path());
    const reconstruction::FlapMeasures measures = study.measures();
    const analysis::CaseWarnings warnings = analysis::case_warnings(plan, choice.plan.parent_path());
    write_result(report::flap_fields().of(
                     {&measures, &warnings.all, choice.rank ? std::optional(study.candidates()) : std::nullopt}),
                 choice.result);
    return warnings.all.empty() ? done : answer_is_no;
}

}  // namespace

Verb plan_reach_verb() {
    return {
        .name = "reach",
        .about = "measure a flap: reach of its vessels, clearances, warnings; 1: there are warnings",
        .add = [](VerbOptions& verb) -> Action {
            const auto choice = std::make_shared<ReachChoice>();
            add_plan_report_options(verb, *choice);
            verb.flag("--rank", choice->rank,
                      "rank both legs, both ends for the pedicle and both faces; with the reasons of what cannot be");
            verb.add("--take", choice->take,
                     "make the candidate of that number in the ranking an alternative of the plan, with its pieces")
                .range(1, 8);
            verb.add("--alternative", choice->alternative, "its name (default: candidate-N)");
            return [choice] { return reach(*choice); };
        },
            // With --take: the plan.
        .schema =
            [] { return report::schema_of_output({report::flap_fields().schema(), report::plan_fields().schema()}); }};
}

}  // namespace tactus::command
