// SPDX-License-Identifier: Apache-2.0
// What a rig found, as one page with its pictures inside.
#pragma once

#include "tools/study/grippers/rig_report.hpp"

#include <string>

namespace tactus::picture {

std::string rig_html(const study::RigReport& report);

}  // namespace tactus::picture
