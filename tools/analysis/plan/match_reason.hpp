// SPDX-License-Identifier: Apache-2.0
// Explains why a fragment was not placed, with the next step.
#pragma once

#include "tools/analysis/plan/plan_matching.hpp"

#include <string>

namespace tactus::analysis {

enum class MatchWay : std::uint8_t { near, anywhere };

/// For a fragment without a painted face; `as_scanned`, m²: its surface in contact with another one in the scan.
std::string no_fracture_words(double as_scanned);

/// One sentence per cause, with the next step; empty when the fragment fits. `only`: the given partner, or
/// Arrangement::none.
std::string why_not_placed(const plan::CasePlan& plan, const PlanMatching& matching,
                           const fit::Arrangement& arrangement, const PlanMatch& found, int only, MatchWay way);

}  // namespace tactus::analysis
