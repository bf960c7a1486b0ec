// SPDX-License-Identifier: Apache-2.0
// What a plan's page, its listing and its checks say about fits and connections, in the same words.
#pragma once

#include "assets/cases/case_plan.hpp"

#include <string>
#include <vector>

namespace tactus::study {

/// "fit to jaw (0.08 mm rms)", or that this fit is void and how far both have moved from each other since. Empty for a
/// fragment that was never fitted.
std::string fit_words(const cases::PlanState& state, int fragment);

/// Whether a surgeon decided on the place, rather than a fit of surfaces (plan_accept.hpp).
bool is_accepted(const cases::PlanFit& fit);

/// One line per connected part with more than one fragment, and one for all that are connected to nothing. A plan of
/// one fragment, or with fewer shown, has none.
std::vector<std::string> connection_words(const cases::CasePlan& plan, const cases::PlanState& state);

/// The names of the connected parts, the largest part first.
std::vector<std::vector<std::string>> assembly_names(const cases::CasePlan& plan, const cases::PlanState& state);

/// Whether all shown fragments hang together by fits that hold.
bool is_in_one_part(const cases::PlanState& state);

}  // namespace tactus::study
