// SPDX-License-Identifier: Apache-2.0
// How the scene is seen: displays, stereo, the head, and windows of their own.
#include "dsp/core/error.hpp"
#include "tools/window/scene/scene_panel.hpp"

#include <utility>

namespace tactus::window {

using render::parse_offset;
using render::parse_stereo;

void ScenePanel::use(const SightChoice& choice) {
    Sight sight(choice);
    if (model_) sight.follow(model_->outline());
    sight_ = std::move(sight);
    display_file_ = choice.display.string();
    if (!choice.offset.empty()) offset_ = choice.offset;
    windows_ = Windows::as_display_file;
    needs_picture_ = true;
}

void ScenePanel::use_stereo(const std::string& mode) {
    const bool is_number = mode.size() == 1 && mode[0] >= '0' && mode[0] <= '3';
    sight_.stereo = is_number ? static_cast<display::StereoMode>(mode[0] - '0') : parse_stereo(mode);
    // Quad-buffering is chosen when a window is opened.
    if (screens_.are_open() || sight_.stereo == display::StereoMode::quad_buffer)
        windows_ = screens_.are_open() ? Windows::all : Windows::as_display_file;
    needs_picture_ = true;
}

void ScenePanel::use_head(const std::string& port) {
    sight_.head = port;
    needs_picture_ = true;
}

void ScenePanel::use_display(const std::string& file) {
    sight_.use_display(file);
    if (model_) sight_.follow(model_->outline());
    display_file_ = file;
    offset_ = "as the display file says";
    windows_ = file.empty() ? Windows::none : Windows::as_display_file;
    needs_picture_ = true;
}

void ScenePanel::use_offset(const std::string& offset) {
    sight_.set_offset(parse_offset(offset));
    offset_ = offset;
    needs_picture_ = true;
}

void ScenePanel::show_screens(bool wanted) { windows_ = wanted ? Windows::all : Windows::none; }

/// Opens and closes windows between two frames of the scene.
void ScenePanel::service_screens() {
    screens_.tend();
    const Windows wanted = std::exchange(windows_, Windows::as_they_are);
    if (wanted == Windows::as_they_are) return;
    needs_picture_ = true;
    motion_.forget();
    note_.clear();
    screens_.close();
    if (wanted == Windows::none) return;
    try {
        screens_.open(sight_, wanted == Windows::all);
    } catch (const Error& error) {
        bench_.tell(note_ = error.what(), true);
        if (sight_.stereo == display::StereoMode::quad_buffer) sight_.stereo = display::StereoMode::side_by_side;
    }
}

/// Ports for head and device; the model observes the scene's own ports.
void ScenePanel::watch_sight() {
    const std::vector<std::string> wanted = sight_.ports();
    if (wanted == watched_) return;
    for (const std::string& port : watched_) observer_->watch(port, observe::Watch::nothing, this);
    for (const std::string& port : wanted) observer_->watch(port, observe::Watch::latest, this);
    watched_ = wanted;
}

}  // namespace tactus::window
