// SPDX-License-Identifier: Apache-2.0
// Why a fragment was not placed, and what to do next.
#pragma once

#include "tools/study/planning/plan_matching.hpp"

#include <string>

namespace tactus::study {

enum class MatchWay : std::uint8_t { near, anywhere };

/// Of a fragment without a painted face; `as_scanned`, m²: of its surface that touches another one in the scan.
std::string no_fracture_words(double as_scanned);

/// One sentence per cause, with the next step; empty when the fragment fits. `only`: the partner that was named, or
/// Arrangement::none.
std::string why_not_placed(const cases::CasePlan& plan, const PlanMatching& matching,
                           const fit::Arrangement& arrangement, const PlanMatch& found, int only, MatchWay way);

}  // namespace tactus::study
