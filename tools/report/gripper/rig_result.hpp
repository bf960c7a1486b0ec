// SPDX-License-Identifier: Apache-2.0
// A study of grippers on the test rig as a result.
#pragma once

#include "tools/analysis/gripper/rig_report.hpp"
#include "tools/report/result/fields.hpp"

#include <string>

namespace tactus::report {

const Fields<analysis::RigReport>& rig_fields();

/// A row per cell.
std::string rig_table(const analysis::RigReport& report);

}  // namespace tactus::report
