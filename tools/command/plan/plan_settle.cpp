// SPDX-License-Identifier: Apache-2.0
// tactus plan settle: refines fitted fragments against all their neighbours.
#include "dsp/core/error.hpp"
#include "tools/analysis/plan/match_reason.hpp"
#include "tools/analysis/plan/plan_words.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/report/plan/match_result.hpp"
#include "tools/report/result/printers.hpp"

namespace tactus::command {

namespace {

struct SettleChoice : PlanChoice {
    int passes = 1;
};

/// All fragments with a fit that holds and that are not locked.
std::vector<int> held_fragments(const plan::PlanState& state) {
    std::vector<int> numbers;
    for (int n = 0; n < static_cast<int>(state.fits.size()); ++n)
        if (state.holds(n) && state.arrangement.can_move(n)) numbers.push_back(n);
    return numbers;
}

/// The named fragments, or all fragments with a fit that holds and that are not locked.
std::vector<int> settled_fragments(const plan::CasePlan& plan, const std::vector<std::string>& names) {
    std::vector<int> numbers;
    for (const std::string& name : names) numbers.push_back(plan::find_fragment(plan, name));
    if (numbers.empty()) numbers = held_fragments(plan::state_of(plan));
    if (numbers.empty())
        throw Error(
            "no fragment that can move has a fit that holds; see 'tactus plan show', and run 'tactus plan snap' "
            "first");
    return numbers;
}

int settle(const SettleChoice& choice) {
    constexpr int max_rounds = 4;
    check_plan_results(choice);
    analysis::OpenPlan open(choice.plan);
    plan::CasePlan& plan = open.plan;
    const std::vector<int> numbers = settled_fragments(plan, choice.names);
    const std::vector<int> held = held_fragments(plan::state_of(plan));
    analysis::PlanMatching matching(plan, choice.plan.parent_path(), fit_way(choice));
    report::SettledFragments result;
    bool all_fit = true;
    const auto settle_one = [&](int n) {
        const fit::Arrangement now = plan::state_of(plan).arrangement;
        const analysis::PlanMatch found = matching.near(now, n, analysis::Partners::all);
        const std::string reason =
            analysis::why_not_placed(plan, matching, now, found, fit::Arrangement::none, analysis::MatchWay::near);
        const bool fits = found.match.verdict == fit::FitVerdict::fit;
        if (fits) analysis::change_plan(plan, analysis::settling(found.match), {.by = "settle"}, choice.plan);
        all_fit = all_fit && fits;
        result.rows.push_back({&plan, found, reason});
    };
    for (int pass = 0; pass < choice.passes; ++pass)
        for (const int n : numbers) settle_one(n);
    // A fragment that was settled before its partner may have lost its fit.
    for (int round = 0; round < max_rounds; ++round)
        for (const int n : held)
            if (!plan::state_of(plan).holds(n)) settle_one(n);
    const plan::PlanState state = plan::state_of(plan);
    result.assemblies = analysis::assembly_names(plan, state);
    result.connections = analysis::connection_words(plan, state);
    write_result(report::settled_fields().of(result), choice.result);
    return all_fit && analysis::is_in_one_part(state) ? done : answer_is_no;
}

Action declare_plan_settle(VerbOptions& verb) {
    const auto choice = std::make_shared<SettleChoice>();
    add_plan_report_options(verb, *choice);
    verb.add("fragments", choice->names, "fragments to settle (default: all fitted ones)");
    verb.add("--passes", choice->passes, "how often").range(1, 20);
    add_fit_options(verb, *choice);
    return [choice] { return settle(*choice); };
}

}  // namespace

Verb plan_settle_verb() {
    return {
        .name = "settle",
        .about =
            "refine fitted fragments, each against all its neighbours; 1: one does not fit, or the fragments are not "
            "connected",
        .add = declare_plan_settle,
        .schema = [] { return report::schema_of_output({report::settled_fields().schema()}); }};
}

}  // namespace tactus::command
