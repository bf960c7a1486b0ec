// SPDX-License-Identifier: Apache-2.0
#include "tools/view/questions.hpp"

#include "tools/view/spots.hpp"

#include <imgui.h>

#include <algorithm>

namespace tactus::view {

namespace {

/// Opens a modal dialog until it is answered. True: draw its content.
bool begin_question(const char* title) {
    if (!ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, ImVec2(0.5f, 0.5f));
    return ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize);
}

/// `spot`: its name for scripts.
bool answer(const char* label, const char* spot, bool has_escape = false) {
    const bool pressed =
        ImGui::Button(label) || (has_escape && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)));
    mark_spot(spot);
    if (pressed) ImGui::CloseCurrentPopup();
    ImGui::SameLine();
    return pressed;
}

}  // namespace

void Questions::draw() {
    if (bench_.wants_name) return ask_name();
    if (leaving == Leaving::asks) return ask_leaving();
    if (bench_.offer()) offer_edits();
}

void Questions::ask_leaving() {
    if (!begin_question("Unsaved edits")) return;
    ImGui::Text("%s has unsaved edits.", bench_.editor().file().filename().c_str());
    if (answer("Save", "save edits")) {
        if (bench_.save()) leaving = Leaving::leaves;
        else {
            leaving = Leaving::none;
            leaves_when_saved_ = bench_.wants_name;
        }
    }
    if (answer("Don't save", "drop edits")) {
        bench_.drop_edits();
        leaving = Leaving::leaves;
    }
    if (answer("Cancel (Esc)", "cancel closing", true)) leaving = Leaving::none;
    ImGui::EndPopup();
}

void Questions::ask_name() {
    if (name_[0] == '\0') {
        const std::string free = bench_.free_file().string();
        std::copy_n(free.c_str(), std::min(free.size(), name_.size() - 1), name_.begin());
    }
    if (!begin_question("Save as")) return;
    ImGui::Text("Patches of the library cannot be changed. Save the patch as:");
    ImGui::SetNextItemWidth(36.0f * ImGui::GetFontSize());
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    const bool entered = ImGui::InputText("##file", name_.data(), name_.size(), ImGuiInputTextFlags_EnterReturnsTrue);
    mark_spot("file name");
    if (!problem_.empty()) ImGui::TextWrapped("%s", problem_.c_str());
    if (answer("Save", "save as") || entered) {
        if (!bench_.save_as(name_.data())) problem_ = bench_.messages().back().text;
        else if (leaves_when_saved_) leaving = Leaving::leaves;
    }
    if (answer("Cancel (Esc)", "cancel saving", true)) bench_.wants_name = false;
    if (!bench_.wants_name) {
        leaves_when_saved_ = false;
        name_.fill('\0');
        problem_.clear();
    }
    ImGui::EndPopup();
}

void Questions::offer_edits() {
    if (!begin_question("Unsaved edits of an earlier window")) return;
    ImGui::Text("An earlier window on this patch closed with unsaved edits:\n%s", bench_.offer()->c_str());
    if (answer("Restore", "restore edits")) bench_.restore_edits();
    // The next file opens another dialog.
    else if (answer("Discard", "discard edits")) bench_.discard_offer();
    ImGui::EndPopup();
}

}  // namespace tactus::view
