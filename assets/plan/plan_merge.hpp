// SPDX-License-Identifier: Apache-2.0
// Combines two plans of one case that were changed independently.
#pragma once

#include "assets/plan/case_plan.hpp"

#include <string>
#include <vector>

namespace tactus::plan {

/// Names of alternatives that a merge has changed.
struct MergedAlternatives {
    std::vector<std::string> added;
    std::vector<std::string> forwarded;  ///< they were moved on to later steps of the other plan
};

/// Adds to `plan` the fragments, steps and alternatives of `other` that it lacks; no step of either is lost. Steps with
/// the same content and the same predecessors are one step. `base`: the common ancestor; null: unknown. An alternative of
/// `other` that differs from that of the same name in `plan` and in `base` (without a base: that has new steps) is moved
/// on if only `other` has changed it, and otherwise becomes an alternative of its own, "main (2)". The current
/// alternative stays the current one. Throws Error, without a change, when a fragment of the same name has another file,
/// and when there would be more alternatives than PlanHistory::max_alternatives.
MergedAlternatives merge(CasePlan& plan, const CasePlan& other, const CasePlan* base);

}  // namespace tactus::plan
