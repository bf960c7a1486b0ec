// SPDX-License-Identifier: Apache-2.0
// The buttons of the plan's panel.
#pragma once

namespace tactus::window {

/// On the same line if it fits. A button that cannot be pressed is dim.
bool plan_button(const char* label, bool can, const char* tip, bool is_first = false);

}  // namespace tactus::window
