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
/// plan. Throws Error for a file that is missing or has changed.
std::vector<PlanOverlap> plan_overlaps(const cases::CasePlan& plan, const std::filesystem::path& folder);

/// m, how deep two placed fragments lie in each other: points of either inside of the other; 0 when they do not.
double deepest_between(const CaseFragment& a, const Pose& at, const CaseFragment& b, const Pose& there);

/// "'a' and 'b' lie in each other with 12 mm³; move or hide one of them".
std::string overlap_words(const cases::CasePlan& plan, const PlanOverlap& overlap);

}  // namespace tactus::study
