// SPDX-License-Identifier: Apache-2.0
// tactus plan move: places a fragment.
#include "assets/transform/transform_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/plan/plan_case.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/command/pose_text.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace tactus::command {

namespace {

struct MoveChoice : PlanChoice {
    std::string pose;
    std::filesystem::path transform;
};

int move_fragment(const MoveChoice& choice) {
    if (choice.pose.empty() == choice.transform.empty()) throw Error("a place is needed: --pose or --transform");
    const Pose pose =
        choice.pose.empty() ? transform::read_motion(choice.transform) : pose_of_text(choice.pose, "--pose");
    analysis::OpenPlan open(choice.plan);
    plan::CasePlan& plan = open.plan;
    const int fragment = plan::find_fragment(plan, choice.names.front());
    const bool is_moved =
        analysis::change_plan(plan, plan::PlaceFragment{fragment, pose}, {.by = "command"}, choice.plan);
    constexpr double far = 2.0;  // m: no bone is that long, nor that far from the origin of its scan
    if (glm::length(pose.position) > far)
        fmt::print(stderr, "note: the position is {:.1f} m from the origin of the scan; are the numbers in mm?\n",
                   glm::length(pose.position));
    return show_change(choice, is_moved);
}

Action declare_plan_move(VerbOptions& verb) {
    const auto choice = std::make_shared<MoveChoice>();
    add_plan_options(verb, *choice);
    add_fragments(verb, *choice, "which one").count(1);
    verb.add("--pose", choice->pose, "X,Y,Z,QW,QX,QY,QZ: p_case = R p_file + t, in mm");
    verb.add("--transform", choice->transform,
             "transform of ITK or 3D Slicer (.tfm, .h5) that moves the file's bone there");
    return [choice] { return move_fragment(*choice); };
}

}  // namespace

Verb plan_move_verb() { return {"move", "place a fragment and its group", declare_plan_move}; }

}  // namespace tactus::command
