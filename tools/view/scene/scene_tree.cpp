// SPDX-License-Identifier: Apache-2.0
// The bones and bodies of the scene as a list: show, hide, choose.
#include "tools/view/scene/scene_panel.hpp"
#include "tools/view/spots.hpp"

namespace tactus::view {

void ScenePanel::draw_tree() {
    if (!model_ || model_->parts().empty()) return ImGui::TextDisabled("The patch has no bones or bodies.");
    const auto show_all = [&](bool wanted) {
        for (const SceneModel::Part& part : model_->parts()) model_->show_part(part.name, wanted);
        needs_picture_ = true;
    };
    if (ImGui::SmallButton("show all")) show_all(true);
    mark_spot("show all");
    ImGui::SameLine();
    if (ImGui::SmallButton("hide all")) show_all(false);
    mark_spot("hide all");
    ImGui::SameLine();
    ImGui::TextDisabled("a picture only: the run goes on with all");
    if (bench_.can_cut()) {
        if (ImGui::SmallButton(is_siting ? "click on the bone" : "cut here...")) is_siting = !is_siting;
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("the next click on the bone moves the saw there; it can be undone");
        mark_spot("cut here");
    }
    for (const SceneModel::Part& part : model_->parts()) {
        ImGui::PushID(part.name.c_str());
        bool is_shown = part.is_shown;
        if (ImGui::Checkbox("##shown", &is_shown)) {
            model_->show_part(part.name, is_shown);
            needs_picture_ = true;
        }
        mark_spot("show " + part.name);
        ImGui::SameLine();
        const auto part_of = [](double x) { return static_cast<float>(x); };
        ImGui::ColorButton("##colour",
                           ImVec4(part_of(part.colour.x), part_of(part.colour.y), part_of(part.colour.z), 1.0f),
                           ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop);
        ImGui::SameLine();
        const bool is_chosen = model_->chosen_part() == part.name;
        if (ImGui::Selectable(part.name.c_str(), is_chosen)) {
            model_->choose_part(is_chosen ? "" : part.name);
            needs_picture_ = true;
        }
        mark_spot("part " + part.name);
        ImGui::PopID();
    }
}

}  // namespace tactus::view
