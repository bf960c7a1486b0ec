// SPDX-License-Identifier: Apache-2.0
// Texts about fits and connections, common to a plan's page, its listing and its checks.
#pragma once

#include "assets/plan/case_plan.hpp"

#include <string>
#include <vector>

namespace tactus::analysis {

/// Returns "fit to jaw (0.08 mm rms)", or that this fit is void and how far the two have moved apart since. Empty for a
/// fragment that was never fitted.
std::string fit_words(const plan::PlanState& state, int fragment);

/// Returns whether a surgeon's decision, not a fit of surfaces, determined the pose (plan_accept.hpp).
bool is_accepted(const plan::PlanFit& fit);

/// Returns one line per connected part with more than one fragment, and one for all unconnected fragments. Empty for a
/// plan with fewer than two shown fragments.
std::vector<std::string> connection_words(const plan::CasePlan& plan, const plan::PlanState& state);

/// Returns the names of the fragments of each connected part, the largest part first.
std::vector<std::vector<std::string>> assembly_names(const plan::CasePlan& plan, const plan::PlanState& state);

/// Returns whether valid fits connect all shown fragments.
bool is_in_one_part(const plan::PlanState& state);

}  // namespace tactus::analysis
