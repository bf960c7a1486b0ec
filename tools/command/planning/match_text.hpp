// SPDX-License-Identifier: Apache-2.0
// The match of a fragment of a plan as text and JSON.
#pragma once

#include "tools/command/pose_text.hpp"
#include "tools/study/planning/plan_matching.hpp"

namespace tactus::command {

/// In a JSON type.
template <class Json>
Json match_json(const cases::CasePlan& plan, const study::PlanMatch& found) {
    const fit::FragmentMatch& match = found.match;
    const auto name = [&plan](int n) { return plan.fragments[static_cast<std::size_t>(n)].name; };
    return {{"fragment", name(match.moving)},
            {"partner", match.partner == fit::Arrangement::none ? Json(nullptr) : Json(name(match.partner))},
            {"verdict", fit::name_of(match.verdict)},
            {"placed", match.verdict == fit::FitVerdict::fit},
            {"as_scanned", found.as_scanned},
            {"faces", match.faces},
            {"score", match.quality.score},
            {"margin", match.margin},
            {"rms_mm", match.quality.rms * 1e3},
            {"gap_mm", match.quality.gap * 1e3},
            {"penetration_mm", match.quality.penetration * 1e3},
            {"overlap_mm2", match.quality.overlap * 1e6},
            {"pose", pose_json<Json>(match.pose)},
            {"moved", motion_json<Json>(found.moved)},
            {"paint", found.was_painted ? "file" : "proposed"}};
}

/// Prints one line on standard output.
void print_match(const cases::CasePlan& plan, const study::PlanMatch& found);

}  // namespace tactus::command
