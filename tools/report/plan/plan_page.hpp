// SPDX-License-Identifier: Apache-2.0
// A plan as a report, which becomes HTML or PDF: warnings, fits, pictures, gaps, order of steps.
#pragma once

#include "dsp/fit/registration/registration.hpp"
#include "tools/analysis/plan/case_warnings.hpp"
#include "tools/analysis/plan/plan_case.hpp"
#include "tools/report/blocks/report_block.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::report {

/// `warnings`: analysis::case_warnings of the plan; `fragments`: of the plan, in its order; `to_healthy`: m, the median distance of each from the healthy side where it is
/// planned, as far as there is one; `healthy`: that side in the frame of the case, for maps of the distance from it; null:
/// none; `first`: what comes before the warnings. Throws Error when pictures cannot be made.
std::vector<ReportBlock> plan_blocks(const plan::CasePlan& plan, const std::vector<analysis::CaseWarning>& warnings,
                                     std::vector<analysis::CaseFragment> fragments,
                                     std::vector<std::optional<double>> to_healthy = {},
                                     const fit::RegistrationTarget* healthy = nullptr,
                                     std::vector<ReportBlock> first = {});

/// The same as one HTML page.
std::string plan_page(const plan::CasePlan& plan, const std::vector<analysis::CaseWarning>& warnings,
                      std::vector<analysis::CaseFragment> fragments, std::vector<std::optional<double>> to_healthy = {},
                      const fit::RegistrationTarget* healthy = nullptr);

}  // namespace tactus::report
