// SPDX-License-Identifier: Apache-2.0
#include "tools/view/scene/scene_panel.hpp"

#include "dsp/core/error.hpp"
#include "tools/view/frame/damage.hpp"
#include "tools/view/spots.hpp"
#include "tools/view/theme.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

namespace tactus::view {

using picture::outline_of;
using picture::parse_offset;
using picture::parse_stereo;
using picture::SceneOutline;

namespace {

// The scene is much slower to draw than the panels, so its rate is limited while the user does not move it, and reduced
// when it takes more than a third of the time. A tracked head gets the full rate.
constexpr double picture_every_s = 1.0 / 30.0, most_wait_s = 1.0;
// Triangle counts for software rendering: above the first, moving scenes are drawn coarsely and quickly; above the
// second, one sample per pixel is smooth enough.
constexpr std::size_t many_triangles = 20'000, very_many_triangles = 300'000;

/// Waits until what was drawn is there, and says meanwhile that the window is alive: what is held stays held in a
/// picture that takes longer than the longest hold.
void finish(SceneHand& hand) {
    constexpr GLuint64 turn_ns = 100'000'000;
    constexpr int most_turns = 10;
    const GLsync drawn = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    for (int turn = 0; turn < most_turns; ++turn) {
        if (glClientWaitSync(drawn, GL_SYNC_FLUSH_COMMANDS_BIT, turn_ns) != GL_TIMEOUT_EXPIRED) break;
        hand.beat();
    }
    glDeleteSync(drawn);
}

}  // namespace

void ScenePanel::attempt(const std::function<void()>& what) {
    try {
        what();
    } catch (const Error& error) {
        bench_.tell(error.what(), true);
    }
}

void ScenePanel::look_from(display::NamedView view) {
    camera.look_from(view);
    is_aimed_ = false;
}

void ScenePanel::reset() {
    look_from(display::NamedView::iso);
    clip(-1, 0.5);
    is_measuring = false;
    marks_.clear();
}

std::span<const SceneModel::Part> ScenePanel::parts() const {
    return model_ ? std::span(model_->parts()) : std::span<const SceneModel::Part>();
}

void ScenePanel::use_map(std::shared_ptr<const picture::SurfaceMap> map, double range) {
    map_ = std::move(map);
    set_map_range(range);
}

void ScenePanel::set_map_range(double range) {
    map_range_ = range;
    if (model_) model_->use_map(map_, map_range_);
    needs_picture_ = true;
}

std::vector<std::shared_ptr<const observe::SeenBody>> ScenePanel::plan_bodies() const {
    return model_ ? model_->plan_bodies() : std::vector<std::shared_ptr<const observe::SeenBody>>();
}

void ScenePanel::use_hardware(std::shared_ptr<const reconstruct::Reconstruction> of) {
    if (model_) model_->use_hardware(std::move(of));
}

const std::map<std::size_t, SceneModel::PlanPiece>& ScenePanel::plan_pieces() const {
    static const std::map<std::size_t, SceneModel::PlanPiece> none;
    return model_ ? model_->plan_pieces() : none;
}

std::string ScenePanel::plan_file() const {
    if (model_)
        for (const SceneOutline::Bodies& scene : model_->outline().scenes)
            if (!scene.plan.empty()) return scene.plan;
    return {};
}

void ScenePanel::compare(std::vector<std::optional<Pose>> poses, const std::string& name) {
    compared_ = std::move(poses);
    compared_name_ = name;
    if (model_) model_->compare(compared_, compared_name_);
    needs_picture_ = true;
}

std::vector<int> ScenePanel::chosen_places() const {
    std::vector<int> places;
    if (!model_) return places;
    for (const std::string& name : model_->chosen_parts())
        for (const SceneModel::Part& part : model_->parts())
            if (part.name == name && part.place >= 0) places.push_back(part.place);
    return places;
}

void ScenePanel::clip(int axis, double share) {
    if (axis == 3 && clip_axis_ != 3) clip_normal_ = camera.orientation * Vec3(0.0, 0.0, 1.0);
    if (axis == 4 && clip_axis_ != 4) {
        const Vec3 normal = marks_.size() == 3 ? glm::cross(marks_[1] - marks_[0], marks_[2] - marks_[0]) : Vec3(0.0);
        if (!(glm::length(normal) > 0.0)) {
            bench_.tell("to clip along a plane of your own, measure three points that are not in a line", true);
            return;
        }
        clip_normal_ = glm::normalize(normal);
    }
    if (axis >= 0 && axis < 3) {
        clip_normal_ = Vec3(0.0);
        clip_normal_[axis] = 1.0;
    }
    clip_axis_ = axis;
    clip_share_ = share;
    needs_picture_ = true;
}

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
void ScenePanel::tend_screens() {
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

void ScenePanel::steer(int width, int height) {
    const bool is_hand = hand_.steer(camera, height);
    steer_by_keys(ImGui::IsItemHovered() || ImGui::IsItemActive());
    if (is_hand || (!ImGui::IsItemHovered() && !ImGui::IsItemActive())) return;
    const ImGuiIO& io = ImGui::GetIO();
    const Point by = point(io.MouseDelta);
    const display::OrbitCamera before = camera;
    if (hand_.has_mouse() && ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 2.0f))
        camera.orbit(-by.x * 2.0 * std::numbers::pi / width, by.y * std::numbers::pi / height);
    else if (ImGui::IsMouseDragging(ImGuiMouseButton_Left, 2.0f) && !io.KeyShift)
        camera.orbit(-by.x * 2.0 * std::numbers::pi / width, by.y * std::numbers::pi / height);
    else if (ImGui::IsMouseDragging(ImGuiMouseButton_Right, 2.0f) ||
             ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 2.0f) ||
             ImGui::IsMouseDragging(ImGuiMouseButton_Left, 2.0f))
        camera.pan(by.x / height, -by.y / height);
    if (io.MouseWheel != 0.0f) camera.zoom(std::pow(1.15, static_cast<double>(io.MouseWheel)));
    // Who moves the view before all of the scene has come has aimed it.
    if (camera.distance != before.distance || camera.target != before.target)
        is_aimed_ = is_aimed_ || !model_->bounds().empty();
    needs_picture_ = needs_picture_ || before.eye() != camera.eye() || before.target != camera.target;
}

/// Sides and turns wherever the pointer is, for those who have none. `is_pointed_at`: letters that other panels have, too.
void ScenePanel::steer_by_keys(bool is_pointed_at) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput || io.KeyCtrl || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) return;
    const display::OrbitCamera before = camera;
    for (int key = 1; key <= 7; ++key)
        if (ImGui::IsKeyPressed('0' + key, false)) look_from(*display::view_of_number(key));
    if (is_pointed_at && ImGui::IsKeyPressed('F', false)) fit();
    if (is_pointed_at && ImGui::IsKeyPressed('R', false)) reset();
    constexpr double turn_rad = 0.1, nearer = 1.15;
    const auto pressed = [&](ImGuiKey key) { return io.KeyAlt && ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); };
    if (pressed(ImGuiKey_LeftArrow)) camera.orbit(-turn_rad, 0.0);
    if (pressed(ImGuiKey_RightArrow)) camera.orbit(turn_rad, 0.0);
    if (pressed(ImGuiKey_UpArrow)) camera.orbit(0.0, turn_rad);
    if (pressed(ImGuiKey_DownArrow)) camera.orbit(0.0, -turn_rad);
    if (pressed(ImGuiKey_PageUp)) camera.zoom(nearer);
    if (pressed(ImGuiKey_PageDown)) camera.zoom(1.0 / nearer);
    if (camera.distance != before.distance) is_aimed_ = is_aimed_ || !model_->bounds().empty();
    needs_picture_ = needs_picture_ || before.eye() != camera.eye() || before.target != camera.target;
}

void ScenePanel::render(int width, int height) {
    const double now = ImGui::GetTime();
    const bool same_size = width == width_ && height == height_;
    if (std::exchange(was_drawn_, false)) cost_s_ = static_cast<double>(ImGui::GetIO().DeltaTime);
    const double every = std::clamp((sight_.is_off_axis() ? 1.0 : 3.0) * cost_s_,
                                    sight_.is_off_axis() ? 0.0 : picture_every_s, most_wait_s);
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
    if (!is_aimed_ && !model_->bounds().empty()) {
        camera.fit(model_->bounds(), aspect);
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

std::optional<display::Plane> ScenePanel::clip_plane() const {
    if (clip_axis_ < 0 || model_->bounds().empty()) return std::nullopt;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& corner : model_->bounds().corners()) {
        low = std::min(low, glm::dot(corner, clip_normal_));
        high = std::max(high, glm::dot(corner, clip_normal_));
    }
    const Vec3 middle = 0.5 * (model_->bounds().low + model_->bounds().high);
    const double at = low + clip_share_ * (high - low);
    return display::Plane{middle + clip_normal_ * (at - glm::dot(middle, clip_normal_)), clip_normal_};
}

/// Ports for head and device; the model observes the scene's own ports.
void ScenePanel::watch_sight() {
    const std::vector<std::string> wanted = sight_.ports();
    if (wanted == watched_) return;
    for (const std::string& port : watched_) observer_->watch(port, observe::Watch::nothing, this);
    for (const std::string& port : wanted) observer_->watch(port, observe::Watch::latest, this);
    watched_ = wanted;
}

bool ScenePanel::is_empty() {
    if (bench_.plan() && judged_version_ != bench_.plan_version()) {
        is_empty_ = outline_of(*bench_.plan()).empty();
        judged_version_ = bench_.plan_version();
    }
    return is_empty_;
}

void ScenePanel::rest() {
    if (!observer_) return;
    if (screens_.are_open()) windows_ = Windows::all;
    screens_.close();
    for (const std::string& port : watched_) observer_->watch(port, observe::Watch::nothing, this);
    watched_.clear();
    model_.reset();
    hand_.forget();
    observer_.reset();
    motion_.forget();
    plan_version_ = -1;
}

void ScenePanel::draw(const std::shared_ptr<observe::Observer>& observer, const Fonts& fonts) {
    if (!observer || !bench_.plan()) return ImGui::TextDisabled("no run");
    try {
        if (!renderer_) renderer_ = std::make_unique<display::SceneRenderer>();
        if (observer != observer_) {
            model_.reset();
            observer_ = observer;
            watched_.clear();
            motion_.forget();
            plan_version_ = -1;
        }
        if (plan_version_ != bench_.plan_version()) {
            SceneOutline outline = outline_of(*bench_.plan());
            if (!model_) model_ = std::make_unique<SceneModel>(std::move(outline), *observer_, *renderer_);
            else model_->follow(std::move(outline));
            model_->use_map(map_, map_range_);
            model_->compare(compared_, compared_name_);
            sight_.follow(model_->outline());
            hand_.follow(observer_, model_->outline());
            plan_version_ = bench_.plan_version();
            is_aimed_ = false;
        }
        watch_sight();
        tools();
        const Point corner = point(ImGui::GetCursorScreenPos()), size = point(ImGui::GetContentRegionAvail());
        // On high-density screens the picture has full resolution.
        const double dense = std::max(1.0, static_cast<double>(ImGui::GetIO().DisplayFramebufferScale.x));
        const int width = static_cast<int>(size.x * dense), height = static_cast<int>(size.y * dense);
        if (width < 8 || height < 8) return;
        ImGui::InvisibleButton(
            "space", vec(size),
            ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
        mark_spot("scene picture");
        steer(static_cast<int>(size.x), static_cast<int>(size.y));
        tend_screens();
        render(width, height);
        const bool is_clicked = ImGui::IsItemHovered() && ImGui::IsMouseReleased(ImGuiMouseButton_Left) &&
                                ImGui::GetIO().MouseDragMaxDistanceSqr[0] < 9.0f;
        const Point clicked = (point(ImGui::GetIO().MousePos) - corner) * dense;
        if (is_clicked && is_siting) move_site(clicked);
        else if (is_clicked && is_measuring) measure(clicked);
        else if (is_clicked) choose(clicked);
        if (hand_.has_mouse() && ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))
            lead_hand(clicked);
        const Painter paint(ImGui::GetWindowDrawList(), fonts);
        if (sight_.display_file())
            paint.box({corner.x, corner.y, corner.x + size.x, corner.y + size.y}, colour(0x0b0e13), 6.0);
        for (std::size_t i = 0; i < screens_.tiles().size(); ++i) {
            const SceneScreens::Tile& tile = screens_.tiles()[i];
            const Point at = corner + Point{tile.x / dense, tile.y / dense};
            const Point far = at + Point{tile.width / dense, tile.height / dense};
            say_version(tile.texture, tile.version);
            paint.list()->AddImageRounded(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(tile.texture)),
                                          vec(at), vec(far), ImVec2(0, 1), ImVec2(1, 0), 0xFFFFFFFF,
                                          static_cast<float>(6.0 * fonts.scale));
            if (sight_.display_file())
                paint.text(at + Point{8.0, 6.0}, 11.0 * fonts.scale, colour(0x1e293b),
                           sight_.display_file()->screens[i].name);
        }
        draw_cursor(paint, corner, 1.0 / dense);
        draw_marks(paint, corner, 1.0 / dense);
        draw_hand(paint, corner, size, 1.0 / dense);
        if (!screens_.are_open()) draw_legend(paint, corner, static_cast<int>(size.y), fonts.scale);
    } catch (const Error& error) {
        if (problem_ != error.what()) bench_.tell(problem_ = error.what(), true);
        ImGui::TextWrapped("%s", problem_.c_str());
    }
}

}  // namespace tactus::view
