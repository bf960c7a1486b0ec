// SPDX-License-Identifier: Apache-2.0
// Texts about fits and connections, common to a plan's page, its listing and its checks.
#pragma once

#include "assets/cases/case_plan.hpp"

#include <string>
#include <vector>

namespace tactus::study {

/// Returns "fit to jaw (0.08 mm rms)", or that this fit is void and how far the two have moved apart since. Empty for a
/// fragment that was never fitted.
std::string fit_words(const cases::PlanState& state, int fragment);

/// Returns whether a surgeon's decision, not a fit of surfaces, determined the pose (plan_accept.hpp).
bool is_accepted(const cases::PlanFit& fit);

/// Returns one line per connected part with more than one fragment, and one for all unconnected fragments. Empty for a
/// plan with fewer than two shown fragments.
std::vector<std::string> connection_words(const cases::CasePlan& plan, const cases::PlanState& state);

/// Returns the names of the fragments of each connected part, the largest part first.
std::vector<std::vector<std::string>> assembly_names(const cases::CasePlan& plan, const cases::PlanState& state);

/// Returns whether valid fits connect all shown fragments.
bool is_in_one_part(const cases::PlanState& state);

}  // namespace tactus::study
