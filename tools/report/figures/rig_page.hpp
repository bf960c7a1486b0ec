// SPDX-License-Identifier: Apache-2.0
// The results of a rig study as one HTML page with figures.
#pragma once

#include "tools/analysis/gripper/rig_report.hpp"

#include <string>

namespace tactus::report {

std::string rig_html(const analysis::RigReport& report);

}  // namespace tactus::report
