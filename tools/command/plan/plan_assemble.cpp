// SPDX-License-Identifier: Apache-2.0
// tactus plan assemble: puts all shown fragments of a plan together as far as their fractures say how.
#include "assets/file/json.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/plan/match_reason.hpp"
#include "tools/analysis/plan/plan_assembly.hpp"
#include "tools/analysis/plan/plan_words.hpp"
#include "tools/command/plan/match_text.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/counted.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::command {

namespace {

using file::Json;

/// Adds a step for each fragment that is placed; the caller saves the plan.
void add_steps(plan::CasePlan& plan, const analysis::PlanAssembly& made) {
    const std::string now = plan::time_of_day();
    for (const analysis::PlanMatch& placed : made.placed) {
        using Outcome = plan::PlanHistory::Outcome;
        const Outcome outcome = plan::change(plan, analysis::settling(placed.match), {.by = "assemble", .time = now});
        if (outcome != Outcome::done) throw Error(std::string(plan::text_of(outcome)));
    }
}

std::string residual_words(const analysis::FragmentResidual& r) {
    return r.faces == 0 ? "no face lies on another"
                        : fmt::format("{:.3f} mm rms over {} of faces, {:.0f} mm²", r.rms * 1e3,
                                      counted(r.faces, "pair"), r.area * 1e6);
}

struct Told {
    std::vector<std::string> reasons;  ///< of what stays
    std::vector<std::string> problems;
};

Told told_of(const plan::CasePlan& plan, const analysis::PlanMatching& matching, const analysis::PlanAssembly& made,
             const plan::PlanState& state) {
    Told told;
    for (std::size_t n = 0; n < made.stays.size(); ++n) {
        const analysis::PlanMatch& stays = made.stays[n];
        std::string reason =
            stays.as_scanned ? std::string(as_scanned_note)
            : made.is_locked_apart[n]
                ? "it is locked, and so is what it would go to; unlock one of them ('tactus plan unlock')"
            : matching.faces_of(stays.match.moving) == 0
                ? analysis::no_fracture_words(matching.as_scanned_area(stays.match.moving))
                : analysis::why_not_placed(plan, matching, state.arrangement, stays, fit::Arrangement::none,
                                           analysis::MatchWay::anywhere);
        told.reasons.push_back(std::move(reason));
    }
    for (const analysis::PlanOverlap& o : made.overlaps) told.problems.push_back(analysis::overlap_words(plan, o));
    return told;
}

/// The whole part stays that the fragment belongs to.
std::vector<std::string> part_of(const plan::CasePlan& plan, const analysis::PlanAssembly& made, int fragment) {
    std::vector<std::string> names;
    for (const auto& part : made.parts)
        if (std::ranges::find(part, fragment) != part.end())
            for (const int n : part) names.push_back(plan.fragments[static_cast<std::size_t>(n)].name);
    return names;
}

Json json_of(const plan::CasePlan& plan, const analysis::PlanMatching& matching, const analysis::PlanAssembly& made,
             const Told& told, const plan::PlanState& state, bool is_done) {
    Json placed = Json::array(), stays = Json::array(), residuals = Json::array();
    for (const analysis::PlanMatch& p : made.placed) placed.push_back(match_json<Json>(plan, p, ""));
    for (std::size_t n = 0; n < made.stays.size(); ++n) {
        Json row = match_json<Json>(plan, made.stays[n], told.reasons[n]);
        row["part"] = part_of(plan, made, made.stays[n].match.moving);
        stays.push_back(std::move(row));
    }
    for (std::size_t n = 0; n < made.residuals.size(); ++n) {
        const analysis::FragmentResidual& r = made.residuals[n];
        if (state.arrangement.is_hidden(static_cast<int>(n))) continue;
        residuals.push_back({{"fragment", plan.fragments[n].name},
                             {"rms_mm", r.faces > 0 ? Json(r.rms * 1e3) : Json(nullptr)},
                             {"overlap_mm2", r.area * 1e6},
                             {"faces", r.faces}});
    }
    return {{"version", 1},
            {"ok", is_done},
            {"placed", placed},
            {"stays", stays},
            {"residuals", residuals},
            {"as_scanned_mm2", left_out_json<Json>(plan, matching, state.arrangement)},
            {"assemblies", analysis::assembly_names(plan, state)},
            {"problems", told.problems}};
}

void print(const plan::CasePlan& plan, const analysis::PlanAssembly& made, const Told& told,
           const plan::PlanState& state) {
    for (const analysis::PlanMatch& placed : made.placed) print_match(plan, placed, "");
    for (std::size_t n = 0; n < made.stays.size(); ++n) {
        const auto names = part_of(plan, made, made.stays[n].match.moving);
        fmt::print("{} {} apart: {}\n", fmt::join(names, ", "), names.size() > 1 ? "stay" : "stays", told.reasons[n]);
    }
    for (std::size_t n = 0; n < made.residuals.size(); ++n)
        if (!state.arrangement.is_hidden(static_cast<int>(n)))
            fmt::print("{}: {}\n", plan.fragments[n].name, residual_words(made.residuals[n]));
    for (const std::string& line : analysis::connection_words(plan, state)) fmt::print("{}\n", line);
    for (const std::string& problem : told.problems) fmt::print("! {}\n", problem);
}

int assemble(const PlanChoice& choice) {
    analysis::OpenPlan open(choice.plan);
    plan::CasePlan& plan = open.plan;
    const plan::PlanState before = plan::state_of(plan);
    if (analysis::assembly_names(plan, before).empty())
        throw Error("no fragment is shown; show some with 'tactus plan unhide'");
    analysis::PlanMatching matching(plan, choice.plan.parent_path(), fit_way(choice));
    const analysis::PlanAssembly made = analysis::assemble(matching, before.arrangement, before.fits);
    add_steps(plan, made);
    const plan::PlanState state = plan::state_of(plan);
    const Told told = told_of(plan, matching, made, state);
    // All steps are written at once: a command that is stopped leaves the plan as it was.
    if (!made.placed.empty()) plan::save_case_plan(plan, choice.plan);
    const bool is_done = analysis::is_in_one_part(state) && told.problems.empty();
    if (choice.json) fmt::print("{}\n", json_of(plan, matching, made, told, state, is_done).dump(2));
    else {
        print(plan, made, told, state);
        print_left_out(plan, matching, state.arrangement);
    }
    return is_done ? done : answer_is_no;
}

Action declare_plan_assemble(VerbOptions& verb) {
    const auto choice = std::make_shared<PlanChoice>();
    add_plan_options(verb, *choice);
    add_fit_options(verb, *choice);
    return [choice] { return assemble(*choice); };
}

}  // namespace

Verb plan_assemble_verb() {
    return {
        "assemble",
        "put all shown fragments together, the surest fits first; 1: they are in several parts, or lie in each other",
        declare_plan_assemble};
}

}  // namespace tactus::command
