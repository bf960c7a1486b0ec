// SPDX-License-Identifier: Apache-2.0
// Results of a rig study as JSON, CSV and text.
#pragma once

#include "tools/analysis/gripper/rig_report.hpp"

#include <string>

namespace tactus::command {

std::string rig_json(const analysis::RigReport& report);
std::string rig_csv(const analysis::RigReport& report);
std::string rig_text(const analysis::RigReport& report);

}  // namespace tactus::command
