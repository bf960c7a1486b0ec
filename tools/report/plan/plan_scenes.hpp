// SPDX-License-Identifier: Apache-2.0
// Pictures of a plan for its report: as scanned, as planned, and coloured by distances.
#pragma once

#include "tools/report/plan/drawn_plan.hpp"
#include "tools/report/result/fields.hpp"

namespace tactus::report {

/// The shown fragments and vessels from four directions, and coloured by their distance from the healthy side.
const Fields<DrawnPlan>& scenes_fields();

/// Gaps and overlaps with maps of the faces.
const Fields<DrawnPlan>& drawn_gaps_fields();

}  // namespace tactus::report
