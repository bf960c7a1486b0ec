// SPDX-License-Identifier: Apache-2.0
// Fragments of a plan that lie in each other.
#pragma once

#include "tools/study/planning/plan_case.hpp"

#include <string>
#include <vector>

namespace tactus::study {

struct PlanOverlap {
    int first = 0, second = 0;
    double volume = 0.0;  ///< m³ of both
};

/// Pairs of shown fragments that lie in each other deeper than a fit may, at the poses of the plan. `folder`: of the
/// plan. What is found is kept (see kept_result.hpp): a fragment is only loaded when a result with it is not known.
/// `notes` gets sentences about kept results that were no use. Throws Error for a file that is missing or has changed.
std::vector<PlanOverlap> plan_overlaps(const cases::CasePlan& plan, const std::filesystem::path& folder,
                                       std::vector<std::string>& notes);

/// "'a' and 'b' lie in each other with 12 mm³; move or hide one of them".
std::string overlap_words(const cases::CasePlan& plan, const PlanOverlap& overlap);

}  // namespace tactus::study
