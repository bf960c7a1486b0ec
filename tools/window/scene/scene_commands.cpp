// SPDX-License-Identifier: Apache-2.0
// What can be done to the scene without a mouse.
#include "tools/window/scene/scene_panel.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::window {

void ScenePanel::add_commands(std::vector<Command>& all) {
    if (!model_) return;
    const auto add = [&](std::string name, const char* about, std::function<void()> run) {
        all.push_back({"scene", std::move(name), "", about, std::move(run)});
    };
    for (const SceneModel::Part& part : model_->parts()) {
        if (part.is_out_of_plan) continue;
        const auto& chosen = model_->chosen_parts();
        const bool is_chosen = std::ranges::find(chosen, part.name) != chosen.end();
        add(fmt::format("{} {}", is_chosen ? "Choose no longer" : "Choose", part.name), "select fragment part pick",
            [this, name = part.name] {
                if (model_) model_->choose_part(name, true);
                needs_picture_ = true;
            });
        add(fmt::format("{} {} in the scene", part.is_shown ? "Hide" : "Show", part.name), "visible part",
            [this, name = part.name, wanted = !part.is_shown] {
                if (model_) model_->show_part(name, wanted);
                needs_picture_ = true;
            });
    }
    add("Fit the scene into its picture", "camera whole", [this] { fit(); });
    static constexpr const char* clips[] = {"Clip nothing", "Clip the scene along x", "Clip the scene along y",
                                            "Clip the scene along z", "Clip the scene along the view"};
    for (int axis = -1; axis <= 3; ++axis)
        add(clips[axis + 1], "section plane cut", [this, axis] { clip(axis, clip_share_); });
    add("Clip the scene through three measured points", "section plane cut oblique", [this] { clip_through_marks(); });
    if (clip_axis_ < 0) return;
    constexpr double step = 0.05;
    add("Clip more", "section plane", [this] { clip(clip_axis_, std::max(0.0, clip_share_ - step)); });
    add("Clip less", "section plane", [this] { clip(clip_axis_, std::min(1.0, clip_share_ + step)); });
}

}  // namespace tactus::window
