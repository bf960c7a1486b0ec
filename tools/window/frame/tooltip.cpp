// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/tooltip.hpp"

#include <imgui.h>

namespace tactus::window {

void show_tooltip(const std::string& text) {
    constexpr float max_letters = 26.0f;  // of full width, about twice as many of usual text
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(max_letters * ImGui::GetFontSize());
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

}  // namespace tactus::window
