// SPDX-License-Identifier: Apache-2.0
// Lets mouse and keys move the hand in place of the device of the patch.
#pragma once

#include "tools/window/document/workbench.hpp"
#include "tools/window/frame/commands.hpp"

#include <vector>

namespace tactus::window {

/// A button that takes the hand, or gives it back; nothing where there is nothing to take.
void draw_hand_offer(Workbench& bench);
void add_hand_commands(Workbench& bench, std::vector<Command>& all);

}  // namespace tactus::window
