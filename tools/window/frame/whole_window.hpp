// SPDX-License-Identifier: Apache-2.0
// The beginning of a picture of the window.
#pragma once

#include "tools/window/widgets/painter.hpp"

namespace tactus::window {

/// Begins a picture: one area that fills the window, in the font of texts. Ends with ImGui::End and ImGui::PopFont.
void begin_whole_window(const char* name, const Fonts& fonts);

}  // namespace tactus::window
