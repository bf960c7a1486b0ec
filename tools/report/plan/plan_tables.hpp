// SPDX-License-Identifier: Apache-2.0
// Tables and lists of a plan's report.
#pragma once

#include "tools/analysis/plan/case_warnings.hpp"
#include "tools/report/blocks/report_block.hpp"
#include "tools/report/plan/drawn_plan.hpp"

namespace tactus::report {

/// What a reader must know before anything else; nothing without warnings.
void add_warnings(const std::vector<analysis::CaseWarning>& warnings, std::vector<ReportBlock>& out);

/// Which fragments are connected by fits.
void add_connections(const DrawnPlan& c, std::vector<ReportBlock>& out);

/// Per fragment: how far it was moved, its fit, its distance from the healthy side.
ReportTable fragments_table(const DrawnPlan& c);

/// Vessels of the case with their nearest bone; nothing without vessels.
void add_vessels(const DrawnPlan& c, std::vector<ReportBlock>& out);

void add_mirror(const DrawnPlan& c, std::vector<ReportBlock>& out);

/// Pose of each fragment, as in the exported files.
ReportTable places(const DrawnPlan& c);

void add_steps(const DrawnPlan& c, std::vector<ReportBlock>& out);
ReportList alternatives(const plan::CasePlan& plan);

}  // namespace tactus::report
