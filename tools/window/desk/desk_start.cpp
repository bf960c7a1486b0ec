// SPDX-License-Identifier: Apache-2.0
// The start page over what is open.
#include "tools/window/desk/desk.hpp"

#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <utility>

namespace tactus::window {

void Desk::open_start_page() {
    start_page_.open();
    start_told_ = bench_.told();
}

/// The page has no list of messages: only what went wrong since it opened.
void Desk::draw_problem() {
    const auto& all = bench_.messages();
    const bool is_there = bench_.told() > start_told_ && !all.empty() && all.back().is_problem;
    const float wide = ImGui::GetContentRegionAvail().x;
    const char* const text = is_there ? all.back().text.c_str() : "";
    const float high =
        is_there ? ImGui::CalcTextSize(text, nullptr, false, wide).y + ImGui::GetStyle().ItemSpacing.y : 0.0f;
    ImGui::BeginChild("start", ImVec2(0.0f, is_there ? -high : 0.0f));
    start_page_.draw(fonts_);
    ImGui::EndChild();
    if (!is_there) return;
    ImGui::PushStyleColor(ImGuiCol_Text, tone::bad);
    ImGui::TextWrapped("%s", text);
    ImGui::PopStyleColor();
    mark_spot("problem");
}

void Desk::draw_start() {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, vec({8.0 * fonts_.scale, 6.0 * fonts_.scale}));
    draw_problem();
    ImGui::PopStyleVar();
    scene_.rest();
    if (std::exchange(start_page_.wants_new, false)) wishes.new_patch = true;
    if (std::exchange(start_page_.wants_dialog, false)) ask_open();
    if (const auto path = std::exchange(start_page_.chosen, std::nullopt)) wishes.open = *path;
    const bool has_popup = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup) || dialog_.is_open() || list_.is_open();
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)) && !has_popup) start_page_.is_open = false;
    ask_farewell();
    draw_dialogs();
    if (farewell != Farewell::asks && !dialog_.is_open()) questions.draw();
    if (std::exchange(questions.has_restored, false)) start_page_.is_open = false;
    ImGui::End();
    ImGui::PopFont();
}

}  // namespace tactus::window
