// SPDX-License-Identifier: Apache-2.0
// Where a person has put the borders between panels, as text. No user interface.
#pragma once

#include "tools/window/frame/layout.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tactus::window {

/// One line for each arrangement of panels: "0.64 patch 0.7 scopes 0.3 | 0.36 scene 0.5 node 0.5".
std::string text_of_borders(const std::vector<std::vector<LayoutColumn>>& arrangements);
/// Lines that are damaged are left out.
std::vector<std::vector<LayoutColumn>> borders_of_text(std::string_view text);

}  // namespace tactus::window
