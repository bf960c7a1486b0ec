// SPDX-License-Identifier: Apache-2.0
// tactus plan move: places a fragment.
#include "tools/command/planning/plan_options.hpp"
#include "tools/command/pose_text.hpp"
#include "tools/study/planning/plan_case.hpp"

namespace tactus::command {

namespace {

struct MoveChoice : PlanChoice {
    std::string pose;
};

int move_fragment(const MoveChoice& choice) {
    study::OpenPlan open(choice.plan);
    cases::CasePlan& plan = open.plan;
    const int fragment = cases::find_fragment(plan, choice.names.front());
    study::do_step(plan, cases::placing(plan, fragment, pose_of_text(choice.pose, "--pose"), "command"), choice.plan);
    return show_change(choice);
}

Action declare_plan_move(VerbOptions& verb) {
    const auto choice = std::make_shared<MoveChoice>();
    add_plan_options(verb, *choice);
    add_fragments(verb, *choice, "which one").count(1);
    verb.add("--pose", choice->pose, "X,Y,Z,QW,QX,QY,QZ: p_case = R p_file + t, in mm").required();
    return [choice] { return move_fragment(*choice); };
}

}  // namespace

Verb plan_move_verb() { return {"move", "place a fragment and its group", declare_plan_move}; }

}  // namespace tactus::command
