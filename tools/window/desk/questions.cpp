// SPDX-License-Identifier: Apache-2.0
#include "tools/window/desk/questions.hpp"

#include "dsp/core/error.hpp"
#include "tools/window/widgets/spots.hpp"

#include <imgui.h>

namespace tactus::window {

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

void Questions::want_all() {
    bench_.want_edits();
    if (plan_) plan_->want();
}

void Questions::draw() {
    // One dialog after the other: the plan first, for which the window was opened.
    if (leaving == Leaving::asks) return plan_ && plan_->has_unsaved_steps() ? ask_leaving_plan() : ask_leaving();
    if (leaving != Leaving::none) return;
    if (plan_ && plan_->offer()) offer_steps();
    else if (bench_.offer()) offer_edits();
}

void Questions::ask_leaving_plan() {
    if (!begin_question("Unsaved steps")) return;
    ImGui::Text("%s has unsaved steps.", plan_->file().filename().c_str());
    if (answer("Save", "save steps"))
        leaving = save_plan && save_plan() ? after_saving() : plan_->needs_name() ? Leaving::saves : Leaving::none;
    if (answer("Don't save", "drop steps")) {
        plan_->drop();
        leaving = after_saving();
    }
    if (answer("Cancel (Esc)", "cancel closing", true)) leaving = Leaving::none;
    ImGui::EndPopup();
}

void Questions::offer_steps() {
    if (!begin_question("Unsaved steps of an earlier window")) return;
    ImGui::Text("An earlier window on this plan ended with unsaved steps:\n%s", plan_->offer()->c_str());
    try {
        if (answer("Restore", "restore steps")) {
            plan_->restore();
            has_restored = true;
            bench_.tell("the unsaved steps are restored; save the plan to keep them");
        } else if (answer("Discard", "discard steps")) plan_->discard_offer();
        else if (answer("Later (Esc)", "later steps", true)) plan_->postpone_offer();
    } catch (const Error& error) {
        bench_.tell(error.what(), true);
    }
    ImGui::EndPopup();
}

void Questions::named(bool is_saved) {
    if (leaving == Leaving::saves) leaving = is_saved ? after_saving() : Leaving::none;
}

void Questions::ask_leaving() {
    if (!begin_question("Unsaved edits")) return;
    ImGui::Text("%s has unsaved edits.", bench_.editor().file().filename().c_str());
    if (answer("Save", "save edits"))
        leaving = bench_.save() ? after_saving() : bench_.wants_name ? Leaving::saves : Leaving::none;
    if (answer("Don't save", "drop edits")) {
        bench_.drop_edits();
        leaving = after_saving();
    }
    if (answer("Cancel (Esc)", "cancel closing", true)) leaving = Leaving::none;
    ImGui::EndPopup();
}

void Questions::offer_edits() {
    if (!begin_question("Unsaved edits of an earlier window")) return;
    ImGui::Text("An earlier window on this patch closed with unsaved edits:\n%s", bench_.offer()->c_str());
    // The next file opens another dialog.
    if (answer("Restore", "restore edits")) has_restored = bench_.restore_edits() || has_restored;
    else if (answer("Discard", "discard edits")) bench_.discard_offer();
    else if (answer("Later (Esc)", "later edits", true)) bench_.postpone_offer();
    ImGui::EndPopup();
}

}  // namespace tactus::window
