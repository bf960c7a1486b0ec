// SPDX-License-Identifier: Apache-2.0
// Where the controls of the window are, for a test that moves a real pointer.
#pragma once

#include <string>

namespace tactus::window {

/// A line for each control of the last frame: name, left, top, right and bottom in pixels, separated by tabs.
std::string spot_list();

}  // namespace tactus::window
