// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/cut_letters.hpp"

#include "assets/file/whole_file.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>

namespace tactus::window {

namespace {

using Corners = std::array<float, 4>;  // left, top, right, bottom

std::filesystem::path& wanted() {
    static std::filesystem::path file;
    return file;
}

/// Letters by their place in the texture.
std::map<Corners, ImWchar> letters_in(const ImFontAtlas& atlas) {
    std::map<Corners, ImWchar> letters;
    for (const ImFont* font : atlas.Fonts)
        for (const ImFontGlyph& glyph : font->Glyphs)
            letters[{glyph.U0, glyph.V0, glyph.U1, glyph.V1}] = static_cast<ImWchar>(glyph.Codepoint);
    return letters;
}

struct Scrolls {
    bool across = false, down = false;
};

/// Of a panel and those around it.
Scrolls scrolls_of(const ImGuiWindow* panel) {
    Scrolls scrolls;
    for (; panel; panel = panel->Flags & ImGuiWindowFlags_ChildWindow ? panel->ParentWindow : nullptr) {
        // ImGui counts what lies beyond a border also where nothing can scroll to it.
        scrolls.across |= panel->ScrollMax.x > 0.0f && (panel->Flags & ImGuiWindowFlags_HorizontalScrollbar) != 0;
        // A list that has just become longer scrolls from the next frame on.
        const bool is_longer = panel->DC.CursorMaxPos.y > panel->InnerRect.Max.y;
        scrolls.down |=
            (panel->ScrollMax.y > 0.0f || is_longer) && (panel->Flags & ImGuiWindowFlags_NoScrollWithMouse) == 0;
    }
    return scrolls;
}

/// Whether borders cut a letter: the clip rectangle when it is drawn, or ImGui before, which then leaves a part of its
/// place in the texture.
bool is_cut(const Corners& at, const Corners& in_texture, const ImVec4& clip, Scrolls scrolls,
            const std::map<Corners, ImWchar>& letters, ImWchar& letter) {
    constexpr float slack = 1.0f;  // letters have an empty border
    const bool is_outside = at[2] <= clip.x || at[0] >= clip.z || at[3] <= clip.y || at[1] >= clip.w;
    if (is_outside) return false;
    const auto whole = letters.find(in_texture);
    if (whole != letters.end()) {
        letter = whole->second;
        const bool across = at[0] < clip.x - slack || at[2] > clip.z + slack,
                   down = at[1] < clip.y - slack || at[3] > clip.w + slack;
        return (across && !scrolls.across) || (down && !scrolls.down);
    }
    for (const auto& [corners, code] : letters) {
        const bool is_part = in_texture[0] >= corners[0] && in_texture[2] <= corners[2] &&
                             in_texture[1] >= corners[1] && in_texture[3] <= corners[3];
        if (!is_part) continue;
        letter = code;
        const float wide = std::max(in_texture[2] - in_texture[0], 1e-9f),
                    high = std::max(in_texture[3] - in_texture[1], 1e-9f);
        const float lost_across = (corners[2] - corners[0] - wide) * (at[2] - at[0]) / wide,
                    lost_down = (corners[3] - corners[1] - high) * (at[3] - at[1]) / high;
        return (lost_across > slack && !scrolls.across) || (lost_down > slack && !scrolls.down);
    }
    return false;
}

std::string letters_of(const ImGuiWindow& panel, const ImFontAtlas& atlas, const std::map<Corners, ImWchar>& letters) {
    const Scrolls scrolls = scrolls_of(&panel);
    std::string text;
    for (const ImDrawCmd& command : panel.DrawList->CmdBuffer) {
        if (command.UserCallback || command.GetTexID() != atlas.TexID) continue;
        const ImDrawIdx* const index = panel.DrawList->IdxBuffer.Data + command.IdxOffset;
        const ImDrawVert* const vertices = panel.DrawList->VtxBuffer.Data + command.VtxOffset;
        // A letter is a rectangle of two triangles: 0 1 2, 0 2 3.
        for (unsigned i = 0; i + 5 < command.ElemCount; i += 3) {
            const auto at = [&](unsigned n) -> const ImDrawVert& { return vertices[index[i + n]]; };
            if (index[i + 3] != index[i] || index[i + 4] != index[i + 2]) continue;
            const ImDrawVert &a = at(0), &c = at(2);
            if (a.uv.x >= c.uv.x || a.uv.y >= c.uv.y) continue;
            ImWchar letter = 0;
            if (is_cut({a.pos.x, a.pos.y, c.pos.x, c.pos.y}, {a.uv.x, a.uv.y, c.uv.x, c.uv.y}, command.ClipRect,
                       scrolls, letters, letter))
                text += fmt::format("{}\t{}\t{:.0f}\t{:.0f}\n", panel.Name,
                                    letter < 128 ? static_cast<char>(letter) : '?', a.pos.x, a.pos.y);
        }
    }
    return text;
}

}  // namespace

void want_cut_letters(const std::filesystem::path& file) { wanted() = file; }

void write_cut_letters() {
    if (wanted().empty()) return;
    const ImGuiContext& context = *ImGui::GetCurrentContext();
    const ImFontAtlas& atlas = *context.IO.Fonts;
    const std::map<Corners, ImWchar> letters = letters_in(atlas);
    std::string text;
    for (const ImGuiWindow* panel : context.Windows)
        if (panel->Active && !panel->Hidden) text += letters_of(*panel, atlas, letters);
    file::write_whole_file(std::exchange(wanted(), {}), text);
}

}  // namespace tactus::window
