// SPDX-License-Identifier: Apache-2.0
// The match of a fragment of a plan as text and JSON.
#pragma once

#include "tools/analysis/plan/plan_matching.hpp"
#include "tools/command/pose_text.hpp"

#include <numbers>
#include <string>

namespace tactus::command {

/// In a JSON type. Numbers of a match are null when no faces met. `reason`: why the fragment was not placed, or empty.
template <class Json>
Json match_json(const plan::CasePlan& plan, const analysis::PlanMatch& found, const std::string& reason) {
    const fit::FragmentMatch& match = found.match;
    const auto name = [&plan](int n) { return plan.fragments[static_cast<std::size_t>(n)].name; };
    const bool met = match.partner != fit::Arrangement::none;
    const auto number = [met](double value) { return met ? Json(value) : Json(nullptr); };
    return {{"fragment", name(match.moving)},
            {"partner", met ? Json(name(match.partner)) : Json(nullptr)},
            {"verdict", fit::name_of(match.verdict)},
            {"answer", fit::answer_of(match.verdict)},
            {"bound", met ? bound_json<Json>(match.bound) : Json(nullptr)},
            {"placed", match.verdict == fit::FitVerdict::fit},
            {"reason", reason.empty() ? Json(nullptr) : Json(reason)},
            {"as_scanned", found.as_scanned},
            {"inside", found.inside == fit::Arrangement::none ? Json(nullptr) : Json(name(found.inside))},
            {"apart", found.is_apart},
            {"faces", match.faces},
            {"score", number(match.quality.score)},
            {"margin", number(match.margin)},
            {"held_at_far_end_mm", number(match.precision.far * 1e3)},
            {"held_deg", number(match.precision.turn * 180.0 / std::numbers::pi)},
            {"rms_mm", number(match.quality.rms * 1e3)},
            {"gap_mm", number(match.quality.gap * 1e3)},
            {"penetration_mm", number(match.quality.penetration * 1e3)},
            {"overlap_mm2", number(match.quality.overlap * 1e6)},
            {"pose", met ? pose_json<Json>(match.pose) : Json(nullptr)},
            {"moved", met ? motion_json<Json>(found.moved) : Json(nullptr)},
            {"paint", found.was_painted ? "file" : "proposed"}};
}

/// {fragment: mm²} and a line for each, of the shown fragments that touch another one in the scan: fits leave that out.
template <class Json>
Json left_out_json(const plan::CasePlan& plan, const analysis::PlanMatching& matching, const fit::Arrangement& shown) {
    Json json = Json::object();
    for (int n = 0; n < static_cast<int>(shown.size()); ++n)
        if (const double area = matching.as_scanned_area(n); area > 0.0 && !shown.is_hidden(n))
            json[plan.fragments[static_cast<std::size_t>(n)].name] = area * 1e6;
    return json;
}
void print_left_out(const plan::CasePlan& plan, const analysis::PlanMatching& matching, const fit::Arrangement& shown);

/// Prints one line on standard output, and one for the reason.
void print_match(const plan::CasePlan& plan, const analysis::PlanMatch& found, const std::string& reason);

}  // namespace tactus::command
