// SPDX-License-Identifier: Apache-2.0
// tactus plan snap: moves a fragment of a plan to the pose where its fracture fits.
#include "dsp/core/error.hpp"
#include "tools/analysis/plan/match_reason.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/report/plan/match_result.hpp"
#include "tools/report/result/printers.hpp"

#include <fmt/format.h>

namespace tactus::command {

namespace {

struct SnapChoice : PlanChoice {
    std::string mode = "extended";
    bool takes_uncertain = false;
};

int snap_fragment(const SnapChoice& choice) {
    check_plan_results(choice);
    analysis::OpenPlan open(choice.plan);
    plan::CasePlan& plan = open.plan;
    const std::filesystem::path folder = choice.plan.parent_path();
    const int moving = plan::find_fragment(plan, choice.names[0]);
    const int only = choice.names.size() > 1 ? plan::find_fragment(plan, choice.names[1]) : fit::Arrangement::none;
    if (only == moving) throw Error(fmt::format("'{}' cannot be fitted to itself; name another one", choice.names[0]));
    const plan::PlanState state = plan::state_of(plan);
    const fit::Arrangement& a = state.arrangement;
    if (only != fit::Arrangement::none && a.move_together(moving, only))
        throw Error(fmt::format("'{}' and '{}' move together", choice.names[0], choice.names[1]));
    if (!a.can_move(moving)) throw Error(fmt::format("'{}', or one grouped with it, is locked", choice.names[0]));
    analysis::PlanMatching matching(plan, folder, fit_way(choice));
    if (matching.faces_of(moving) == 0)
        throw Error(fmt::format("fragment '{}': {}", choice.names[0],
                                analysis::no_fracture_words(matching.as_scanned_area(moving))));
    const analysis::MatchWay way = choice.mode == "global" ? analysis::MatchWay::anywhere : analysis::MatchWay::near;
    const analysis::PlanMatch found = way == analysis::MatchWay::anywhere
                                          ? matching.anywhere(a, moving, only)
                                          : matching.near(a, moving, analysis::Partners::standing_first, only);
    const bool fits = found.match.verdict == fit::FitVerdict::fit;
    const std::string reason = analysis::why_not_placed(plan, matching, a, found, only, way);
    // Everything that may fail runs before the plan is changed.
    const auto target =
        analysis::target_distances(state, folder, matching.fragment(moving), found.from, found.match.pose);
    // Where nothing fits, the distance there says nothing.
    const bool is_uncertain = found.match.verdict == fit::FitVerdict::uncertain;
    const bool has_place = fits || is_uncertain || found.as_scanned;
    if (fits) analysis::change_plan(plan, analysis::settling(found.match), {.by = "snap"}, choice.plan);
    // A place that no fit vouches for connects nothing: the step has no fit in it, and 'plan accept' adds the decision.
    if (is_uncertain && choice.takes_uncertain)
        analysis::change_plan(plan, plan::PlaceFragment{moving, found.match.pose}, {.by = "snap"}, choice.plan);
    write_result(report::snapped_fields().of({{&plan, found, reason},
                                              fits || (is_uncertain && choice.takes_uncertain),
                                              report::areas_left_out(plan, matching, a),
                                              target,
                                              has_place}),
                 choice.result);
    return fits ? done : answer_is_no;
}

Action declare_plan_snap(VerbOptions& verb) {
    const auto choice = std::make_shared<SnapChoice>();
    add_plan_report_options(verb, *choice);
    add_fragments(verb, *choice, "the moving fragment (with its group) and the fixed one (default: the best match)")
        .count(1, 2);
    verb.add("--mode", choice->mode, "extended: from the current pose; global: from any pose")
        .one_of({"extended", "global"})
        .shows_default();
    verb.flag("--uncertain", choice->takes_uncertain,
              "put it at an uncertain place, too; only 'tactus plan accept' connects it there");
    add_fit_options(verb, *choice);
    return [choice] { return snap_fragment(*choice); };
}

}  // namespace

Verb plan_snap_verb() {
    return {.name = "snap",
            .about = "fit the fracture of a fragment to another fragment; 1: no fit",
            .add = declare_plan_snap,
            .schema = [] { return report::schema_of_output({report::snapped_fields().schema()}); }};
}

}  // namespace tactus::command
