// SPDX-License-Identifier: Apache-2.0
// Lets mouse and keys move the hand in place of the device of the patch.
#pragma once

#include "tools/view/frame/commands.hpp"
#include "tools/view/workbench.hpp"

#include <vector>

namespace tactus::view {

/// A button that takes the hand, or gives it back; nothing where there is nothing to take.
void draw_hand_offer(Workbench& bench);
void add_hand_commands(Workbench& bench, std::vector<Command>& all);

}  // namespace tactus::view
