// SPDX-License-Identifier: Apache-2.0
#include "tools/window/plan/plan_button.hpp"

#include "tools/window/frame/tooltip.hpp"
#include "tools/window/widgets/spots.hpp"

#include <imgui.h>

namespace tactus::window {

bool plan_button(const char* label, bool can, const char* tip, bool is_first) {
    const float end = ImGui::GetItemRectMax().x + 2.0f * ImGui::GetStyle().ItemSpacing.x +
                      ImGui::CalcTextSize(label).x + 2.0f * ImGui::GetStyle().FramePadding.x;
    if (!is_first && end < ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x) ImGui::SameLine();
    ImGui::BeginDisabled(!can);
    const bool pressed = ImGui::Button(label);
    ImGui::EndDisabled();
    mark_spot(label);
    // Where it was just pressed, its result must be seen.
    const ImVec2 at = ImGui::GetIO().MouseClickedPos[ImGuiMouseButton_Left], low = ImGui::GetItemRectMin(),
                 high = ImGui::GetItemRectMax();
    const bool was_pressed_last = at.x >= low.x && at.x < high.x && at.y >= low.y && at.y < high.y;
    if (!was_pressed_last && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) show_tooltip(tip);
    return pressed;
}

}  // namespace tactus::window
