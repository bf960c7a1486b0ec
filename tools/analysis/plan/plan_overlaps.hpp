// SPDX-License-Identifier: Apache-2.0
// Finds overlapping fragments of a plan.
#pragma once

#include "tools/analysis/plan/plan_case.hpp"

#include <string>
#include <vector>

namespace tactus::analysis {

struct PlanOverlap {
    int first = 0, second = 0;
    double volume = 0.0;  ///< m³ of the overlap
};

/// Returns the pairs of shown fragments that overlap more deeply than a fit may, at the poses of the plan. `folder`: of
/// the plan. Results are cached (see kept_result.hpp): a fragment is loaded only if a result with it is not cached.
/// `notes` receives sentences about invalid cached results. Throws Error for a file that is missing or has changed.
std::vector<PlanOverlap> plan_overlaps(const plan::CasePlan& plan, const std::filesystem::path& folder,
                                       std::vector<std::string>& notes);

/// Returns text such as "'a' and 'b' lie in each other with 12 mm³; move or hide one of them".
std::string overlap_words(const plan::CasePlan& plan, const PlanOverlap& overlap);

}  // namespace tactus::analysis
