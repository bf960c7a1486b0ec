// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/value_dialog.hpp"

#include "dsp/core/error.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <utility>

namespace tactus::window {

void ValueDialog::ask(ValueQuestion question) {
    question_ = std::move(question);
    refusal_.clear();
    is_asked_ = true;
}

bool ValueDialog::enter() {
    try {
        question_.take(question_.value);
        return true;
    } catch (const Error& error) {
        refusal_ = error.message();
        // Enter has left the field.
        wants_focus_ = true;
        return false;
    }
}

void ValueDialog::draw() {
    constexpr const char* title = "value";
    if (std::exchange(is_asked_, false)) {
        ImGui::OpenPopup(title);
        ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    }
    if (!ImGui::BeginPopup(title)) return;
    const float wide = 20.0f * ImGui::GetFontSize();
    ImGui::TextUnformatted(question_.what.c_str());
    if (std::exchange(wants_focus_, false) || ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(wide);
    const bool entered = ImGui::InputText("##value", &question_.value,
                                          ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    mark_spot("value");
    if (entered && enter()) ImGui::CloseCurrentPopup();
    if (!refusal_.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, tone::bad);
        ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + wide);
        ImGui::TextUnformatted(refusal_.c_str());
        ImGui::PopTextWrapPos();
        ImGui::PopStyleColor();
        mark_spot("value refused");
    }
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace tactus::window
