// SPDX-License-Identifier: Apache-2.0
// Gaps and overlaps of the fragments of a plan: table and maps.
#pragma once

#include "tools/report/blocks/report_block.hpp"
#include "tools/report/plan/drawn_plan.hpp"

namespace tactus::report {

struct PlanGaps {
    ReportTable table{{"fragment", "and", "facing, mm²", "touching, mm²", "median gap, mm", "95 %, mm", "deepest, mm",
                       "overlap, mm³"},
                      {}};
    PictureGrid maps;
};

/// Throws Error when no picture can be made.
PlanGaps gaps_of(const DrawnPlan& c);

void add_gaps(const PlanGaps& found, std::vector<ReportBlock>& out);

}  // namespace tactus::report
