// SPDX-License-Identifier: Apache-2.0
// The buttons above the scene's picture.
#include "tools/window/frame/tooltip.hpp"
#include "tools/window/scene/clip_place.hpp"
#include "tools/window/scene/scene_panel.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <array>
#include <cstdio>

namespace tactus::window {

/// The next item stays on the line if it fits, otherwise it starts a new one.
static void stay_on_line(float width) {
    const float end = ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + width;
    if (end < ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x) ImGui::SameLine();
}

static bool next_button(const char* label) {
    stay_on_line(ImGui::CalcTextSize(label).x + 2.0f * ImGui::GetStyle().FramePadding.x);
    return ImGui::SmallButton(label);
}

void ScenePanel::tools() {
    for (std::size_t i = 0; i < display::view_names.size(); ++i) {
        const std::string name(display::view_names[i]);
        if (i == 0 ? ImGui::SmallButton(name.c_str()) : next_button(name.c_str()))
            look_from(static_cast<display::NamedView>(i));
        if (ImGui::IsItemHovered()) show_tooltip(fmt::format("key {}", i + 1));
    }
    if (next_button("fit")) fit();
    if (ImGui::IsItemHovered()) show_tooltip("key F");
    if (next_button("reset")) reset();
    if (ImGui::IsItemHovered()) show_tooltip("key R: iso view, all visible, no clipping");
    if (has_few_tools) return hand_.tools();
    const bool measures = is_measuring;
    if (measures) ImGui::PushStyleColor(ImGuiCol_Button, faded(tone::chosen, 0.45));
    const bool is_measure_pressed = next_button("measure");
    if (measures) ImGui::PopStyleColor();
    if (is_measure_pressed) {
        is_measuring = !is_measuring;
        marks_.clear();
        needs_picture_ = true;
    }
    mark_spot("measure");
    if (ImGui::IsItemHovered()) show_tooltip("two clicks: distance; three: angle at the second");
    sight_tools();
    const float unit = ImGui::GetFontSize();
    stay_on_line(6.0f * unit);
    static const char* const axes[] = {"no clip", "clip x", "clip y", "clip z", "clip view", "clip plane"};
    int axis = clip_axis_ + 1;
    ImGui::SetNextItemWidth(6.0f * unit);
    if (ImGui::Combo("##axis", &axis, axes, 6)) clip(axis - 1, clip_share_);
    mark_spot("clip");
    if (ImGui::IsItemHovered())
        show_tooltip("view: across the line of sight as it is now; plane: through three measured points");
    if (clip_axis_ >= 0) {
        ImGui::SameLine();
        ImGui::SetNextItemWidth(-1.0f);
        const auto [low, high] =
            model_ && !model_->bounds().empty() ? extent_along(model_->bounds(), clip_normal_) : std::array{0.0, 0.0};
        auto place = static_cast<float>(1e3 * (low + clip_share_ * (high - low)));
        if (ImGui::SliderFloat("##clip", &place, static_cast<float>(1e3 * low), static_cast<float>(1e3 * high),
                               "%.1f mm") &&
            high > low)
            clip(clip_axis_, (1e-3 * static_cast<double>(place) - low) / (high - low));
        if (ImGui::IsItemHovered()) show_tooltip("place along the direction of the clip, in the axes of the scene");
    }
    hand_.tools();
}

/// Stereo, head, display file, offset, windows.
void ScenePanel::sight_tools() {
    const float unit = ImGui::GetFontSize();
    const auto chosen = static_cast<std::size_t>(sight_.stereo);
    ImGui::SetNextItemWidth(7.5f * unit);
    if (ImGui::BeginCombo("##stereo", std::string(display::stereo_names[chosen]).c_str())) {
        for (std::size_t i = 0; i < display::stereo_names.size(); ++i)
            if (ImGui::Selectable(std::string(display::stereo_names[i]).c_str(), i == chosen))
                use_stereo(std::string(display::stereo_names[i]));
        ImGui::EndCombo();
    }
    stay_on_line(7.5f * unit);
    ImGui::SetNextItemWidth(7.5f * unit);
    if (ImGui::BeginCombo("##head", sight_.head.empty() ? "no head" : sight_.head.c_str())) {
        if (ImGui::Selectable("no head", sight_.head.empty())) use_head("");
        if (observer_)
            for (const observe::Observer::Port& port : observer_->ports())
                if (port.type == &value::pose && ImGui::Selectable(port.name.c_str(), port.name == sight_.head))
                    use_head(port.name);
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered()) show_tooltip("pose output of the viewer's head; the picture follows it");
    if (next_button("screens...")) ImGui::OpenPopup("screens");
    mark_spot("screens...");
    if (!ImGui::BeginPopup("screens")) return;
    static char file[512] = "";
    if (ImGui::IsWindowAppearing()) std::snprintf(file, sizeof file, "%s", display_file_.c_str());
    ImGui::SetNextItemWidth(24.0f * unit);
    ImGui::InputTextWithHint("display", "file of 'tactus calibrate'", file, sizeof file);
    if (ImGui::Button("use")) attempt([&] { use_display(file); });
    ImGui::SameLine();
    if (ImGui::Button("none")) use_display("");
    ImGui::SameLine();
    if (ImGui::Button("calibrate...")) {
        wants_calibration = true;
        ImGui::CloseCurrentPopup();
    }
    mark_spot("calibrate...");
    if (sight_.display_file()) {
        ImGui::SetNextItemWidth(12.0f * unit);
        if (ImGui::BeginCombo("shift of the picture", offset_.c_str())) {
            for (const char* name : {"none", "study"})
                if (ImGui::Selectable(name, offset_ == name)) use_offset(name);
            ImGui::EndCombo();
        }
        if (ImGui::IsItemHovered()) show_tooltip("study: 0.3 m to the right");
    }
    bool open = screens_.are_open();
    if (ImGui::Checkbox("separate windows", &open)) show_screens(open);
    ImGui::EndPopup();
}

}  // namespace tactus::window
