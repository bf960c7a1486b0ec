// SPDX-License-Identifier: Apache-2.0
// The bones and bodies of the scene as a list: show, hide, choose.
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/terminal.hpp"
#include "tools/window/frame/elide.hpp"
#include "tools/window/frame/tooltip.hpp"
#include "tools/window/scene/scene_panel.hpp"
#include "tools/window/widgets/spots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

namespace tactus::window {

void ScenePanel::draw_tree() {
    if (!model_ || model_->parts().empty())
        return ImGui::TextDisabled(is_empty() ? "The patch has no bones or bodies." : "Nothing is drawn yet.");
    const auto show_all = [&](bool wanted) {
        for (const SceneModel::Part& part : model_->parts()) model_->show_part(part.name, wanted);
        needs_picture_ = true;
    };
    const auto tell = [] {
        if (ImGui::IsItemHovered()) show_tooltip("in the picture only: the run goes on with all");
    };
    if (ImGui::SmallButton("show all")) show_all(true);
    mark_spot("show all");
    tell();
    ImGui::SameLine();
    if (ImGui::SmallButton("hide all")) show_all(false);
    mark_spot("hide all");
    tell();
    if (bench_.can_cut()) {
        if (ImGui::SmallButton(is_siting ? "click on the bone" : "cut here...")) is_siting = !is_siting;
        if (ImGui::IsItemHovered()) show_tooltip("the next click on the bone moves the saw there; it can be undone");
        mark_spot("cut here");
    }
    // What is drawn may change the list.
    const std::vector<SceneModel::Part> parts = model_->parts();
    for (std::size_t place = 0; place < parts.size(); ++place) {
        const SceneModel::Part& part = parts[place];
        if (part.is_out_of_plan) {
            ImGui::TextDisabled(
                "%s", elided(part.name + ", hidden in the plan", static_cast<double>(ImGui::GetContentRegionAvail().x))
                          .c_str());
            mark_spot("hidden " + part.name);
            if (ImGui::IsItemHovered()) show_tooltip("the button \"show hidden\" brings it back: a step of the plan");
            continue;
        }
        ImGui::PushID(static_cast<int>(place));  // several may have one name
        bool is_shown = part.is_shown;
        if (ImGui::Checkbox("##shown", &is_shown)) {
            model_->show_part(part.name, is_shown);
            needs_picture_ = true;
        }
        mark_spot("show " + part.name);
        ImGui::SameLine();
        const auto part_of = [](double x) { return static_cast<float>(x); };
        float colour[3] = {part_of(part.colour.x), part_of(part.colour.y), part_of(part.colour.z)};
        const ImGuiColorEditFlags quiet = ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoLabel |
                                          ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop;
        // Bones are coloured by their density.
        ImGui::BeginDisabled(part.place < 0);
        if (ImGui::ColorEdit3("##colour", colour, quiet)) {
            model_->colour_part(part.name, Vec3(colour[0], colour[1], colour[2]));
            needs_picture_ = true;
        }
        ImGui::EndDisabled();
        ImGui::SameLine();
        const auto& chosen = model_->chosen_parts();
        std::string label = part.name;
        if (part.is_held) label += ", held";
        if (part.is_locked) label += ", locked";
        if (part.unit >= 0) label += fmt::format(", group {}", part.unit + 1);
        if (part.fits >= 0)
            for (const SceneModel::Part& other : parts)
                if (other.place == part.fits) label += ", fits " + other.name;
        const std::string shown = elided(label, static_cast<double>(ImGui::GetContentRegionAvail().x));
        if (ImGui::Selectable((shown + "###name").c_str(), std::ranges::find(chosen, part.name) != chosen.end())) {
            model_->choose_part(part.name, ImGui::GetIO().KeyCtrl);
            needs_picture_ = true;
        }
        mark_spot("part " + part.name);
        if (shown != label && ImGui::IsItemHovered()) show_tooltip(label);
        ImGui::PopID();
    }
    draw_measurements();
}

void ScenePanel::keep_measurement() {
    if (marks_.size() < 2) return;
    measurements_.push_back({fmt::format("measurement {}", measurements_.size() + 1), marks_});
    has_unwritten_ = true;
}

std::filesystem::path ScenePanel::write_measurements() {
    std::filesystem::path folder = folder_of_results.empty() ? bench_.status()->folder : folder_of_results;
    // A take is in a folder of its own.
    const std::filesystem::path beside = bench_.editor().file().parent_path();
    if (folder.empty() && std::filesystem::exists(beside / "take.json")) folder = beside;
    if (folder.empty())
        throw Error("there is no run whose folder would take the measurements; start one, then save them");
    std::filesystem::path file;
    for (int i = 1; file.empty() || std::filesystem::exists(file); ++i)
        file = folder / fmt::format("measurements-{}.mrk.json", i);
    file::write_whole_file(file, render::markups_text(measurements_));
    has_unwritten_ = false;
    return file;
}

void ScenePanel::save_measurements() {
    attempt([&] {
        const std::filesystem::path file = write_measurements();
        bench_.tell(fmt::format("{} measurements written to {}", measurements_.size(), file.string()));
    });
}

ScenePanel::~ScenePanel() {
    if (!has_unwritten_ || measurements_.empty()) return;
    try {
        say(stderr, fmt::format("tactus: the kept measurements are in {}\n", write_measurements().string()));
    } catch (const std::exception& error) {
        say(stderr, fmt::format("tactus: the kept measurements are not saved: {}\n", error.what()));
    }
}

/// Below the parts: what was measured, and kept.
void ScenePanel::draw_measurements() {
    if (marks_.size() < 2 && measurements_.empty()) return;
    ImGui::Separator();
    if (marks_.size() >= 2 && ImGui::SmallButton("keep measurement")) keep_measurement();
    if (marks_.size() >= 2) mark_spot("keep measurement");
    std::size_t dropped = measurements_.size();
    for (std::size_t i = 0; i < measurements_.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::SmallButton("x")) dropped = i;
        ImGui::SameLine();
        ImGui::Text("%s: %s", measurements_[i].name.c_str(), render::measurement_words(measurements_[i]).c_str());
        ImGui::PopID();
    }
    if (dropped < measurements_.size())
        measurements_.erase(measurements_.begin() + static_cast<std::ptrdiff_t>(dropped));
    if (measurements_.empty()) return;
    if (ImGui::SmallButton("save for Slicer")) save_measurements();
    mark_spot("save for Slicer");
    if (ImGui::IsItemHovered())
        show_tooltip("as .mrk.json beside the opened plan, or in the folder of the run; when the window closes, too");
}

}  // namespace tactus::window
