// SPDX-License-Identifier: Apache-2.0
// The results of a rig study as one HTML page with figures.
#pragma once

#include "tools/study/grippers/rig_report.hpp"

#include <string>

namespace tactus::picture {

std::string rig_html(const study::RigReport& report);

}  // namespace tactus::picture
