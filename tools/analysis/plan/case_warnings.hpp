// SPDX-License-Identifier: Apache-2.0
// All warnings of a plan in one list. 'plan show', 'check', 'reach', 'report' and the window all print this list, so
// that they cannot contradict each other.
#pragma once

#include "assets/file/json.hpp"
#include "assets/plan/case_plan.hpp"
#include "dsp/reconstruction/fibula_plan.hpp"
#include "dsp/reconstruction/reach.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::analysis {

struct CaseWarning {
    /// Of the plan: "changed-file", "nothing-shown", "void-fit", "not-connected", "overlap", "vessel-in-bone"; of the
    /// pieces of a reconstruction: "not-placed", "away-from-plan", "accepted-away", "joint-gap"; and the codes of
    /// reconstruction::PlanWarning and FlapTrouble.
    std::string code;
    std::string text;
    std::string object, other;  ///< fragments, screws, vessels; "" if there is none
    /// True if the plan is unfinished or inconsistent: 'plan check' then exits with 1. Others are for a surgeon's
    /// judgement.
    bool is_fault = false;
};

struct CaseWarnings {
    std::vector<CaseWarning> all;
    /// False if overlaps, vessels and hardware were not measured for this version of the plan.
    bool is_measured = true;
    std::vector<std::string> notes;  ///< about invalid cached results

    bool has_fault() const;
};

/// m and rad: tolerance of a piece's pose against the plan, for the rounding of poses.
inline constexpr double max_away = 0.1e-3, max_turned = 0.1 * 3.14159265358979323846 / 180.0;
/// m: largest gap between two faces that are planned to touch. A placeholder, without a source.
inline constexpr double max_joint_gap = 0.5e-3;

/// Returns the whole list for the head of the current alternative. Measurements on the surfaces of fragments are cached
/// by the content of the plan and its files (kept_result.hpp), so that they run once per version of a plan. `folder`:
/// of the plan. Throws Error.
CaseWarnings case_warnings(const plan::CasePlan& plan, const std::filesystem::path& folder);
/// The same without new measurements: warnings that need no surface of a fragment, and others if they are cached. Fast.
CaseWarnings known_warnings(const plan::CasePlan& plan, const std::filesystem::path& folder);

/// Returns the warnings of the cuts and of a flap only, as for a candidate that is not a plan yet. Two objects that are
/// too close to each other give one warning.
std::vector<CaseWarning> warnings_of(const reconstruction::FibulaPlan& fibula,
                                     const reconstruction::FlapMeasures& measures);

/// Returns a list of {code, text, object, other, fault}.
file::Json json_of(const std::vector<CaseWarning>& warnings);

}  // namespace tactus::analysis
