// SPDX-License-Identifier: Apache-2.0
// When and how finely the scene is drawn.
#include "tools/window/scene/scene_panel.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

namespace tactus::window {

namespace {

// The scene is much slower to draw than the panels, so its rate is limited while the user does not move it, and reduced
// when it takes more than a third of the time. A tracked head gets the full rate.
constexpr double picture_every_s = 1.0 / 30.0, max_wait_s = 1.0;
// Triangle counts for software rendering: above the first, moving scenes are drawn coarsely and quickly; above the
// second, one sample per pixel is smooth enough.
constexpr std::size_t many_triangles = 20'000, very_many_triangles = 300'000;

/// Waits until what was drawn is there, and says meanwhile that the window is alive: what is held stays held in a
/// picture that takes longer than the longest hold.
void finish(SceneHand& hand) {
    constexpr GLuint64 turn_ns = 100'000'000;
    constexpr int max_turns = 10;
    const GLsync drawn = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    for (int turn = 0; turn < max_turns; ++turn) {
        if (glClientWaitSync(drawn, GL_SYNC_FLUSH_COMMANDS_BIT, turn_ns) != GL_TIMEOUT_EXPIRED) break;
        hand.beat();
    }
    glDeleteSync(drawn);
}

}  // namespace

void ScenePanel::render(int width, int height) {
    const double now = ImGui::GetTime();
    const bool same_size = width == width_ && height == height_;
    if (std::exchange(was_drawn_, false)) cost_s_ = static_cast<double>(ImGui::GetIO().DeltaTime);
    const double every = std::clamp((sight_.is_off_axis() ? 1.0 : 3.0) * cost_s_,
                                    sight_.is_off_axis() ? 0.0 : picture_every_s, max_wait_s);
    if (!needs_picture_ && is_aimed_ && same_size && now - looked_at_ < every) return;
    looked_at_ = now;
    needs_picture_ = false;
    width_ = width;
    height_ = height;
    hand_.beat();
    model_->show_density(clip_axis_ >= 0);
    display::Picture& picture = model_->update();
    needs_picture_ = needs_picture_ || model_->is_reading_density();
    hand_.beat();
    sight_.update(*observer_);
    screens_.lay_out(sight_, width, height);
    const double aspect =
        static_cast<double>(width) / height * (sight_.mode_of(0) == display::StereoMode::side_by_side ? 0.5 : 1.0);
    // More of the scene has come, and nobody has moved the view since it was fitted.
    if (!model_->is_fitted() && camera.target == fitted_.target && camera.distance == fitted_.distance)
        is_aimed_ = false;
    if (!is_aimed_ && !model_->bounds().empty()) {
        camera.fit(model_->bounds(), aspect);
        fitted_ = camera;
        is_aimed_ = model_->is_fitted();
    }
    picture.clip = clip_plane();
    const auto views = screens_.aim(sight_, camera, picture.bounds);
    const bool has_coarse = renderer_->is_software() && model_->triangles() > many_triangles;
    // In the panel it is an overlay, in separate windows a part of the picture.
    const display::Legend drawn_legend = screens_.are_open() ? legend() : display::Legend{};
    const auto next = motion_.next(looks_of(picture, renderer_->meshes().changes(), views, drawn_legend), has_coarse,
                                   ImGui::IsItemActive(), now);
    if (next == SceneMotion::Next::nothing && screens_.has_steps_left()) return draw_step(picture);
    if (next == SceneMotion::Next::nothing) return screens_.show();
    picture.is_quick = next == SceneMotion::Next::coarse;
    picture.grain = picture.is_quick ? grain_.pixels() : 0.0;
    // A single fine picture of a still scene does not reduce the rate of moving ones.
    was_drawn_ = next == SceneMotion::Next::coarse || !has_coarse;
    const bool is_many = renderer_->is_software() && model_->triangles() > very_many_triangles;
    screens_.samples = picture.is_quick ? grain_.samples() : is_many ? 1 : 4;
    if (next == SceneMotion::Next::fine && has_coarse && !screens_.are_open()) {
        screens_.begin_steps();
        return draw_step(picture);
    }
    hand_.beat();
    screens_.draw(*renderer_, picture, sight_, drawn_legend);
    ++pictures_;
    if (picture.is_quick) grain_.drew(renderer_->drawn_triangles());
    hand_.beat();
    // Without a graphics card the processor draws, and the wait for it would come later, as a whole.
    if (renderer_->is_software()) finish(hand_);
    hand_.beat();
    screens_.show();
}

/// Where the processor draws, all triangles of a large scene take longer than a picture of the window may.
void ScenePanel::draw_step(display::Picture& picture) {
    picture.is_quick = false;
    picture.grain = 0.0;
    const auto begin = std::chrono::steady_clock::now();
    hand_.beat();
    screens_.draw_step(*renderer_, picture);
    ++pictures_;
    finish(hand_);
    hand_.beat();
    screens_.took(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    needs_picture_ = screens_.has_steps_left();
}

}  // namespace tactus::window
