// SPDX-License-Identifier: Apache-2.0
// tactus plan assemble: puts all shown fragments of a plan together as far as their fractures say how.
#include "dsp/core/error.hpp"
#include "tools/analysis/plan/match_reason.hpp"
#include "tools/analysis/plan/plan_assembly.hpp"
#include "tools/analysis/plan/plan_words.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/report/bone/pose_fields.hpp"
#include "tools/report/plan/match_result.hpp"
#include "tools/report/result/printers.hpp"

#include <algorithm>

namespace tactus::command {

namespace {

/// Adds a step for each fragment that is placed; the caller saves the plan.
void add_steps(plan::CasePlan& plan, const analysis::PlanAssembly& made) {
    for (const analysis::PlanMatch& placed : made.placed)
        analysis::apply_command(plan, analysis::settling(placed.match), {.by = "assemble"});
}

/// Why a fragment stays.
std::string reason_of(const plan::CasePlan& plan, const analysis::PlanMatching& matching,
                      const analysis::PlanAssembly& made, std::size_t n, const plan::PlanState& state) {
    const analysis::PlanMatch& stays = made.stays[n];
    if (stays.as_scanned) return report::as_scanned_note;
    if (made.is_locked_apart[n])
        return "it is locked, and so is what it would go to; unlock one of them ('tactus plan unlock')";
    if (matching.faces_of(stays.match.moving) == 0)
        return analysis::no_fracture_words(matching.as_scanned_area(stays.match.moving));
    return analysis::why_not_placed(plan, matching, state.arrangement, stays, fit::Arrangement::none,
                                    analysis::MatchWay::anywhere);
}

/// The whole part stays that the fragment belongs to.
std::vector<std::string> part_of(const plan::CasePlan& plan, const analysis::PlanAssembly& made, int fragment) {
    std::vector<std::string> names;
    for (const auto& part : made.parts)
        if (std::ranges::find(part, fragment) != part.end())
            for (const int n : part) names.push_back(plan.fragments[static_cast<std::size_t>(n)].name);
    return names;
}

int assemble(const PlanChoice& choice) {
    check_plan_results(choice);
    analysis::OpenPlan open(choice.plan);
    plan::CasePlan& plan = open.plan;
    const plan::PlanState before = plan::state_of(plan);
    if (analysis::assembly_names(plan, before).empty())
        throw Error("no fragment is shown; show some with 'tactus plan unhide'");
    analysis::PlanMatching matching(plan, choice.plan.parent_path(), fit_way(choice));
    const analysis::PlanAssembly made = analysis::assemble(matching, before.arrangement, before.fits);
    add_steps(plan, made);
    const plan::PlanState state = plan::state_of(plan);
    report::AssembledFragments result{};
    for (const analysis::PlanMatch& placed : made.placed) result.placed.push_back({&plan, placed});
    for (std::size_t n = 0; n < made.stays.size(); ++n)
        result.stays.push_back({&plan, made.stays[n], reason_of(plan, matching, made, n, state),
                                part_of(plan, made, made.stays[n].match.moving)});
    for (std::size_t n = 0; n < made.residuals.size(); ++n)
        if (!state.arrangement.is_hidden(static_cast<int>(n)))
            result.residuals.emplace_back(plan.fragments[n].name, made.residuals[n]);
    for (const analysis::PlanOverlap& o : made.overlaps) result.problems.push_back(analysis::overlap_words(plan, o));
    result.left_out = report::areas_left_out(plan, matching, state.arrangement);
    result.assemblies = analysis::assembly_names(plan, state);
    result.connections = analysis::connection_words(plan, state);
    result.is_done = analysis::is_in_one_part(state) && result.problems.empty();
    // All steps are written at once: a command that is stopped leaves the plan as it was.
    if (!made.placed.empty()) plan::save_case_plan(plan, choice.plan);
    write_result(report::assembled_fields().of(result), choice.result);
    return result.is_done ? done : answer_is_no;
}

Action declare_plan_assemble(VerbOptions& verb) {
    const auto choice = std::make_shared<PlanChoice>();
    add_plan_report_options(verb, *choice);
    add_fit_options(verb, *choice);
    return [choice] { return assemble(*choice); };
}

}  // namespace

Verb plan_assemble_verb() {
    return {.name = "assemble",
            .about =
                "put all shown fragments together, the surest fits first; 1: they are in several parts, or lie in each "
                "other",
            .add = declare_plan_assemble,
            .schema = [] { return report::schema_of_output({report::assembled_fields().schema()}); }};
}

}  // namespace tactus::command
