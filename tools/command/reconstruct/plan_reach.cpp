// SPDX-License-Identifier: Apache-2.0
// tactus plan reach: whether the vessels of a flap reach, what comes near to what, and which way is best.
#include "assets/cases/plan_file.hpp"
#include "tools/command/planning/plan_options.hpp"
#include "tools/command/reconstruct/flap_text.hpp"
#include "tools/study/planning/flap_study.hpp"

#include <fmt/format.h>

namespace tactus::command {

namespace {

struct ReachChoice : PlanChoice {
    bool rank = false;
};

int reach(const ReachChoice& choice) {
    const cases::CasePlan plan = cases::load_case_plan(choice.plan);
    study::FlapStudy study(plan, cases::state_of(plan), choice.plan.parent_path());
    const reconstruct::FlapMeasures measures = study.measures();
    std::vector<reconstruct::Candidate> candidates;
    if (choice.rank) candidates = study.candidates();
    if (choice.json) {
        file::Json json = flap_json(measures);
        if (choice.rank) json["candidates"] = candidates_json(candidates);
        fmt::print("{}\n", json.dump(2));
    } else {
        print_flap(measures);
        if (choice.rank) print_candidates(candidates);
        fmt::print("for research, not a medical device\n");
    }
    return measures.warnings.empty() ? done : answer_is_no;
}

}  // namespace

Verb plan_reach_verb() {
    return {"reach", "measure a flap: reach of its vessels, clearances, warnings; 1: there are warnings",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<ReachChoice>();
                add_plan_options(verb, *choice);
                verb.flag(
                    "--rank", choice->rank,
                    "rank both legs, both ends for the pedicle and both faces; with the reasons of what cannot be");
                return [choice] { return reach(*choice); };
            }};
}

}  // namespace tactus::command
