// SPDX-License-Identifier: Apache-2.0
// A reconstruction of a jaw as blocks of a report.
#pragma once

#include "assets/plan/case_plan.hpp"
#include "tools/report/blocks/report_block.hpp"

#include <filesystem>
#include <vector>

namespace tactus::report {

/// What the plan's state says of the reconstruction: warnings, pictures, dimension drawings per osteotomy, numbers,
/// candidates, order of steps; and up to three alternatives side by side. Empty when it has none. `folder`: of the plan.
/// Throws Error when files are missing or pictures cannot be made.
std::vector<ReportBlock> flap_blocks(const plan::CasePlan& plan, const std::filesystem::path& folder);

}  // namespace tactus::report
