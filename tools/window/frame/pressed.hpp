// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <imgui.h>

namespace tactus::window {

/// Whether a key went down in this picture, or its repetition came.
inline bool pressed(ImGuiKey_ key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); }

}  // namespace tactus::window
