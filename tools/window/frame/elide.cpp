// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/elide.hpp"

#include <imgui.h>

#include <cstddef>

namespace tactus::window {

std::string elided(const std::string& text, double width) {
    const auto fits = [&](const std::string& part) {
        return static_cast<double>(ImGui::CalcTextSize(part.c_str()).x) <= width;
    };
    if (fits(text)) return text;
    const auto is_inside_character = [&](std::size_t at) {
        return (static_cast<unsigned char>(text[at]) & 0xC0u) == 0x80u;
    };
    for (std::size_t end = text.size(); end > 0;) {
        --end;
        while (end > 0 && is_inside_character(end)) --end;
        if (std::string part = text.substr(0, end) + "…"; fits(part)) return part;
    }
    return "…";
}

}  // namespace tactus::window
