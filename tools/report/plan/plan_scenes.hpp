// SPDX-License-Identifier: Apache-2.0
// Pictures of a plan for its report: as scanned, as planned, and as far as it is from the healthy side.
#pragma once

#include "dsp/fit/registration/registration.hpp"
#include "tools/report/blocks/report_block.hpp"
#include "tools/report/plan/drawn_plan.hpp"

namespace tactus::report {

/// The shown fragments and vessels from four directions. Throws Error when no picture can be made.
void add_pictures(const DrawnPlan& c, std::vector<ReportBlock>& out);

/// All fragments as planned, coloured by their distance from the healthy side. Throws Error as add_pictures.
void add_mirror_maps(const DrawnPlan& c, const fit::RegistrationTarget& healthy, std::vector<ReportBlock>& out);

}  // namespace tactus::report
