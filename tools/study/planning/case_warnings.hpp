// SPDX-License-Identifier: Apache-2.0
// All that may be wrong with a plan, in one list: 'plan show', 'check', 'reach', 'report' and the window print this list and
// no other, so that none of them can contradict another.
#pragma once

#include "assets/cases/case_plan.hpp"
#include "assets/file/json.hpp"
#include "dsp/reconstruct/fibula_plan.hpp"
#include "dsp/reconstruct/reach.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::study {

struct CaseWarning {
    /// Of the plan: "changed-file", "nothing-shown", "void-fit", "not-connected", "overlap", "vessel-in-bone"; of the
    /// pieces of a reconstruction: "not-placed", "away-from-plan", "accepted-away", "joint-gap"; and the codes of
    /// reconstruct::PlanWarning and FlapTrouble.
    std::string code;
    std::string text;
    std::string object, other;  ///< fragments, screws, vessels; "" when there is none
    /// The plan is not finished or contradicts itself: 'plan check' exits with 1. Others are for a surgeon's judgement.
    bool is_fault = false;
};

struct CaseWarnings {
    std::vector<CaseWarning> all;
    /// False: overlaps, vessels and hardware were not measured for this version of the plan.
    bool is_measured = true;
    std::vector<std::string> notes;  ///< about kept results that were no use

    bool has_fault() const;
};

/// m and rad by which a piece may lie away from its planned place: poses in files have more digits.
inline constexpr double max_away = 0.1e-3, max_turned = 0.1 * 3.14159265358979323846 / 180.0;
/// m: between two faces that are planned to meet. A placeholder, not from a source.
inline constexpr double max_joint_gap = 0.5e-3;

/// The whole list for the head of the current alternative. What needs the surfaces of fragments is kept by the content of
/// the plan and its files (kept_result.hpp), so that it is measured once per version of a plan. `folder`: of the plan.
/// Throws Error.
CaseWarnings case_warnings(const cases::CasePlan& plan, const std::filesystem::path& folder);
/// The same without measuring: what needs no surface of a fragment, and the rest if it is kept. Never takes long.
CaseWarnings known_warnings(const cases::CasePlan& plan, const std::filesystem::path& folder);

/// Of the cuts and of a flap alone, as for a candidate that is no plan yet. Two things that come near each other are one
/// warning.
std::vector<CaseWarning> warnings_of(const reconstruct::FibulaPlan& fibula, const reconstruct::FlapMeasures& measures);

/// A list of {code, text, object, other, fault}.
file::Json json_of(const std::vector<CaseWarning>& warnings);

}  // namespace tactus::study
