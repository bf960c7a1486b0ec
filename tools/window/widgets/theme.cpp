// SPDX-License-Identifier: Apache-2.0
#include "tools/window/widgets/theme.hpp"

#include <imgui.h>

namespace tactus::window {

std::uint32_t colour_of(const ValueType* type) {
    if (!type) return tone::text;
    if (type == &value::pose) return colour(0x0a92ff);
    if (type == &value::wrench) return colour(0xe65b53);
    if (type == &value::twist) return colour(0x707bbb);
    if (type == &value::vector) return colour(0xd47291);
    if (type == &value::number) return colour(0xbac7ff);
    if (type == &value::boolean) return colour(0x86fae7);
    if (type == &value::signal) return colour(0xf5a742);
    return colour(0x89efa4);
}

std::uint32_t colour_named(std::string_view name) {
    if (name == "blue") return colour(0x2f5f96);
    if (name == "green") return colour(0x2f7a50);
    if (name == "amber") return colour(0x8f6a1c);
    if (name == "red") return colour(0x93404a);
    if (name == "violet") return colour(0x6a4a95);
    if (name == "teal") return colour(0x1f7277);
    return colour(0x4a5261);
}

void apply_theme(double scale) {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 0.0f;
    style.ChildRounding = style.PopupRounding = 6.0f;
    style.FrameRounding = style.GrabRounding = 4.0f;
    style.WindowPadding = {8.0f, 8.0f};
    style.FramePadding = {8.0f, 4.0f};
    style.ItemSpacing = {8.0f, 6.0f};
    style.ScrollbarSize = 12.0f;
    style.WindowBorderSize = 0.0f;
    style.ChildBorderSize = 0.0f;
    const auto set = [&](ImGuiCol which, std::uint32_t packed) {
        style.Colors[which] = ImGui::ColorConvertU32ToFloat4(packed);
    };
    set(ImGuiCol_WindowBg, tone::ground);
    set(ImGuiCol_ChildBg, tone::lane);
    set(ImGuiCol_PopupBg, colour(0x222a37, 248));
    set(ImGuiCol_Border, tone::lane_edge);
    set(ImGuiCol_Text, tone::text);
    set(ImGuiCol_TextDisabled, tone::dim);
    set(ImGuiCol_FrameBg, colour(0x10141a));
    set(ImGuiCol_FrameBgHovered, colour(0x1d2531));
    set(ImGuiCol_FrameBgActive, colour(0x273243));
    set(ImGuiCol_Button, colour(0x2d3849));
    set(ImGuiCol_ButtonHovered, colour(0x3b4a61));
    set(ImGuiCol_ButtonActive, colour(0x4a5d7a));
    set(ImGuiCol_Header, colour(0x2d3849));
    set(ImGuiCol_HeaderHovered, colour(0x3b4a61));
    set(ImGuiCol_HeaderActive, colour(0x4a5d7a));
    set(ImGuiCol_SliderGrab, colour(0x5ab0ff));
    set(ImGuiCol_SliderGrabActive, colour(0x8cc8ff));
    set(ImGuiCol_CheckMark, colour(0x5ab0ff));
    set(ImGuiCol_Tab, colour(0x1f2733));
    set(ImGuiCol_TabHovered, colour(0x3b4a61));
    set(ImGuiCol_TabActive, colour(0x33415a));
    set(ImGuiCol_Separator, tone::lane_edge);
    style.ScaleAllSizes(static_cast<float>(scale));
}

}  // namespace tactus::window
