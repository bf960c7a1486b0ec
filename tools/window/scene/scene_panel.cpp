// SPDX-License-Identifier: Apache-2.0
#include "tools/window/scene/scene_panel.hpp"

#include "dsp/core/error.hpp"
#include "tools/window/frame/damage.hpp"
#include "tools/window/scene/clip_place.hpp"
#include "tools/window/slices/plan_scan.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

namespace tactus::window {

using render::outline_of;
using render::SceneOutline;

namespace {

std::string plan_of(const SceneOutline& outline) {
    for (const SceneOutline::Bodies& scene : outline.scenes)
        if (!scene.plan.empty()) return scene.plan;
    return {};
}

bool is_case_of(const SceneOutline& one, const SceneOutline& other) {
    return plan_of(one) == plan_of(other) || are_of_one_case(plan_of(one), plan_of(other));
}

}  // namespace

void ScenePanel::attempt(const std::function<void()>& what) {
    try {
        what();
    } catch (const std::exception& error) {
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

void ScenePanel::use_map(std::shared_ptr<const render::SurfaceMap> map, double range) {
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

void ScenePanel::use_plan(const std::filesystem::path& file, const plan::CasePlan& plan, std::int64_t version) {
    // The model compares stamps only.
    if (model_)
        model_->use_plan(file, plan,
                         std::filesystem::file_time_type(std::filesystem::file_time_type::duration(version)));
}

const std::map<std::size_t, SceneModel::PlanPiece>& ScenePanel::plan_pieces() const {
    static const std::map<std::size_t, SceneModel::PlanPiece> none;
    return model_ ? model_->plan_pieces() : none;
}

std::string ScenePanel::plan_file() const { return model_ ? plan_of(model_->outline()) : std::string(); }

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
            if (part.name == name && part.place >= 0 && !part.is_out_of_plan) places.push_back(part.place);
    return places;
}

void ScenePanel::clip(int axis, double share) {
    if (axis == 3 && clip_axis_ != 3) clip_normal_ = camera.orientation * Vec3(0.0, 0.0, 1.0);
    if (axis == 4 && clip_axis_ != 4) return clip_through_marks();
    if (axis >= 0 && axis < 3) {
        clip_normal_ = Vec3(0.0);
        clip_normal_[axis] = 1.0;
    }
    clip_axis_ = axis;
    clip_share_ = share;
    needs_picture_ = true;
}

void ScenePanel::clip_through_marks() {
    const Vec3 normal = marks_.size() == 3 ? glm::cross(marks_[1] - marks_[0], marks_[2] - marks_[0]) : Vec3(0.0);
    if (!(glm::length(normal) > 0.0) || !model_)
        return bench_.tell("to clip along a plane of your own, measure three points that are not in a line", true);
    clip_normal_ = glm::normalize(normal);
    clip_axis_ = 4;
    clip_share_ = share_through(model_->bounds(), clip_normal_, marks_[0]);
    needs_picture_ = true;
}

std::optional<display::Plane> ScenePanel::clip_plane() const {
    if (clip_axis_ < 0 || model_->bounds().empty()) return std::nullopt;
    return plane_at(model_->bounds(), clip_normal_, clip_share_);
}

bool ScenePanel::is_empty() {
    if (bench_.plan() && judged_version_ != bench_.plan_version()) {
        is_empty_ = outline_of(*bench_.plan()).empty();
        judged_version_ = bench_.plan_version();
    }
    return is_empty_;
}

/// What is hidden, chosen or coloured stays so in the next run.
void ScenePanel::forget_model() {
    if (model_) look_ = model_->look();
    model_.reset();
}

void ScenePanel::rest() {
    if (!observer_) return;
    if (screens_.are_open()) windows_ = Windows::all;
    screens_.close();
    for (const std::string& port : watched_) observer_->watch(port, observe::Watch::nothing, this);
    watched_.clear();
    forget_model();
    hand_.forget();
    pulled_.forget();
    observer_.reset();
    motion_.forget();
    plan_version_ = -1;
}

void ScenePanel::draw(const std::shared_ptr<observe::Observer>& observer, const Fonts& fonts) {
    if (!observer || !bench_.plan()) return ImGui::TextDisabled("no run");
    try {
        if (!renderer_) renderer_ = std::make_unique<display::SceneRenderer>();
        if (observer != observer_) {
            forget_model();
            observer_ = observer;
            watched_.clear();
            motion_.forget();
            plan_version_ = -1;
        }
        if (plan_version_ != bench_.plan_version()) {
            SceneOutline outline = outline_of(*bench_.plan());
            // Who has turned a slider or begun again goes on looking from where they are.
            is_aimed_ = is_aimed_ && outline.shows_the_same(aimed_at_) && is_case_of(outline, aimed_at_);
            aimed_at_ = outline;
            if (!model_) {
                model_ = std::make_unique<SceneModel>(std::move(outline), *observer_, *renderer_);
                model_->spread_work();
                moves_shown_ = -1;
                model_->use_look(std::exchange(look_, {}));
            } else model_->follow(std::move(outline));
            model_->use_map(map_, map_range_);
            model_->compare(compared_, compared_name_);
            sight_.follow(model_->outline());
            hand_.follow(observer_, model_->outline(), *bench_.plan());
            pulled_.follow(observer_, model_->outline(), *bench_.plan());
            plan_version_ = bench_.plan_version();
            needs_picture_ = true;
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
        steer(corner, static_cast<int>(size.x), static_cast<int>(size.y));
        follow_mover();
        service_screens();
        render(width, height);
        const bool is_clicked = ImGui::IsItemHovered() && ImGui::IsMouseReleased(ImGuiMouseButton_Left) &&
                                ImGui::GetIO().MouseDragMaxDistanceSqr[0] < 9.0f;
        const Point clicked = (point(ImGui::GetIO().MousePos) - corner) * dense;
        const bool has_hand_click = !is_measuring && !is_siting && ImGui::GetTime() - sited_at_ > 1.0;
        if (is_clicked && is_siting) move_site(clicked);
        else if (is_clicked && is_measuring) measure(clicked);
        else if (is_clicked) choose(clicked);
        if (has_hand_click && hand_.has_mouse() && ImGui::IsItemHovered() &&
            ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))
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
        draw_handles(paint, corner, 1.0 / dense);
        draw_labels(paint, corner, 1.0 / dense);
        for (const render::Measurement& kept : measurements_)
            draw_measured(kept, tone::dim, paint, corner, 1.0 / dense);
        draw_measured({{}, marks_}, tone::chosen, paint, corner, 1.0 / dense);
        draw_hand(paint, corner, size, 1.0 / dense);
        if (!screens_.are_open()) draw_legend(paint, corner, static_cast<int>(size.y), fonts.scale);
    } catch (const std::exception& error) {
        if (problem_ != error.what()) bench_.tell(problem_ = error.what(), true);
        ImGui::TextWrapped("%s", problem_.c_str());
    }
}

}  // namespace tactus::window
