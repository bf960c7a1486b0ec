// SPDX-License-Identifier: Apache-2.0
// Matches of fragments of a plan as results.
#pragma once

#include "tools/analysis/plan/plan_assembly.hpp"
#include "tools/analysis/plan/plan_matching.hpp"
#include "tools/report/result/fields.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::report {

/// A match with the reason why the fragment was not placed, or "". Its numbers are missing if no faces met.
struct JudgedMatch {
    const plan::CasePlan* plan;
    analysis::PlanMatch found;
    std::string reason{};
    std::vector<std::string> part{};  ///< fragments that stay with it

    std::string name_of(int fragment) const { return plan->fragments[static_cast<std::size_t>(fragment)].name; }
    bool has_met() const { return found.match.partner != fit::Arrangement::none; }
};
const Fields<JudgedMatch>& match_fields();

/// The areas of shown fragments that touch another one in the scan, m²: fits leave them out.
std::vector<std::pair<std::string, double>> areas_left_out(const plan::CasePlan& plan,
                                                           const analysis::PlanMatching& matching,
                                                           const fit::Arrangement& shown);

/// 'plan snap'.
struct SnappedFragment {
    JudgedMatch match;
    bool is_moved;
    std::vector<std::pair<std::string, double>> left_out;
    std::optional<analysis::TargetDistances> target;
    bool has_place;
};
const Fields<SnappedFragment>& snapped_fields();

/// 'plan settle'.
struct SettledFragments {
    std::vector<JudgedMatch> rows;
    std::vector<std::vector<std::string>> assemblies;
    std::vector<std::string> connections;  ///< analysis::connection_words
};
const Fields<SettledFragments>& settled_fields();

/// 'plan assemble'. `residuals`: of shown fragments.
struct AssembledFragments {
    bool is_done;
    std::vector<JudgedMatch> placed, stays;
    std::vector<std::pair<std::string, analysis::FragmentResidual>> residuals;
    std::vector<std::pair<std::string, double>> left_out;
    std::vector<std::vector<std::string>> assemblies;
    std::vector<std::string> connections;  ///< analysis::connection_words
    std::vector<std::string> problems;
};
const Fields<AssembledFragments>& assembled_fields();

}  // namespace tactus::report
