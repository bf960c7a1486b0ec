// SPDX-License-Identifier: Apache-2.0
// Results of a rig study as JSON, CSV and text.
#pragma once

#include "tools/study/grippers/rig_report.hpp"

#include <string>

namespace tactus::command {

std::string rig_json(const study::RigReport& report);
std::string rig_csv(const study::RigReport& report);
std::string rig_text(const study::RigReport& report);

}  // namespace tactus::command
