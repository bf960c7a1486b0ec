// SPDX-License-Identifier: Apache-2.0
// A chosen fragment of a plan is dragged: in the plane of the view, by modifier keys, or by handles along and about the
// axes of the scan.
#include "tools/window/scene/scene_panel.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

namespace tactus::window {

namespace {

constexpr float drag_begins_px = 3.0f;  // a click that shakes moves nothing
constexpr double radians_per_pixel = 0.006;  // as the mouse turns a hand
constexpr double handle_px = 64.0, ring_px = 46.0, reach_px = 7.0;
constexpr const char* axis_names[] = {"x", "y", "z"};

ImU32 colour_of_axis(int axis) {
    constexpr std::array<std::uint32_t, 3> colours{0xe5484d, 0x46a758, 0x3e8bff};
    return colour(colours[static_cast<std::size_t>(axis)]);
}

Vec3 along(int axis) {
    Vec3 unit(0.0);
    unit[axis] = 1.0;
    return unit;
}

double distance_to(const std::vector<Point>& line, Point at) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t n = 1; n < line.size(); ++n) {
        const Point way = line[n] - line[n - 1], to = at - line[n - 1];
        const double length2 = way.x * way.x + way.y * way.y;
        const double share = length2 > 0.0 ? std::clamp((to.x * way.x + to.y * way.y) / length2, 0.0, 1.0) : 0.0;
        least = std::min(least, std::hypot(to.x - share * way.x, to.y - share * way.y));
    }
    return least;
}

/// m of one pixel at a place of the scene.
double size_of_pixel(const display::OrbitCamera& camera, const Vec3& at, double height) {
    const Vec3 forward = camera.orientation * Vec3(0.0, 0.0, -1.0);
    const double depth = std::max(glm::dot(at - camera.eye(), forward), 1e-3);
    return 2.0 * depth * std::tan(0.5 * camera.vertical_field_of_view_rad) / std::max(height, 1.0);
}

}  // namespace

/// What a person moves is drawn where it is, before it is a step of the plan.
void ScenePanel::follow_mover() {
    if (!mover_ || moves_shown_ == mover_->version()) return;
    moves_shown_ = mover_->version();
    model_->use_poses(mover_->poses());
    needs_picture_ = true;
}

bool ScenePanel::steer_fragment(Point corner, int height) {
    if (!mover_) return false;
    if (ImGui::IsItemActivated() && ImGui::IsMouseClicked(ImGuiMouseButton_Left) && !is_measuring && !is_siting)
        press_fragment(corner);
    if (grip_ == Grip::none) return false;
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
        if (hold_ == Hold::drags) mover_->cancel();
        hold_ = Hold::ended;
    }
    if (hold_ == Hold::pressed) take_fragment();
    if (hold_ == Hold::drags && !mover_->is_dragging()) hold_ = Hold::ended;
    if (hold_ == Hold::drags) drag_fragment(height);
    if (!ImGui::IsItemActive()) {
        if (hold_ == Hold::drags) mover_->release();
        else if (hold_ == Hold::pressed && !waits_for_.empty())
            bench_.tell(fmt::format("not moved: {}", waits_for_), true);
        grip_ = Grip::none;
        waits_for_.clear();
    }
    return true;
}

/// Only a chosen fragment is taken: a drag elsewhere turns the view.
void ScenePanel::press_fragment(Point corner) {
    const std::vector<int> chosen = chosen_places();
    if (chosen.empty()) return;
    const Point mouse = point(ImGui::GetIO().MousePos);
    const Handle* nearest = nullptr;
    for (const Handle& handle : handles_)
        if (distance_to(handle.line, mouse) < reach_px &&
            (!nearest || distance_to(handle.line, mouse) < distance_to(nearest->line, mouse)))
            nearest = &handle;
    int fragment = nearest ? chosen.back() : -1;
    const double dense = std::max(1.0, static_cast<double>(ImGui::GetIO().DisplayFramebufferScale.x));
    const auto picked = nearest ? std::nullopt : pick((mouse - corner) * dense);
    if (picked) {
        const std::string name = model_->part_of(picked->mesh);
        for (const SceneModel::Part& part : model_->parts())
            if (part.name == name && std::ranges::find(chosen, part.place) != chosen.end()) fragment = part.place;
    }
    if (fragment < 0) return;
    grip_ = nearest ? nearest->grip : Grip::plane;
    grip_axis_ = nearest ? nearest->axis : 0;
    gripped_ = fragment;
    grip_at_.reset();
    if (picked) grip_at_ = picked->position;
    hold_ = Hold::pressed;
    dragged_ = {};
}

/// Takes the pressed fragment, now or as soon as it can be: it then goes to where the pointer is by then.
void ScenePanel::take_fragment() {
    // Until the pointer has left the place of the press, it is a click.
    const ImVec2 total = ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, drag_begins_px);
    if (total.x == 0.0f && total.y == 0.0f && ImGui::GetIO().MouseWheel == 0.0f) return;
    std::string why;
    switch (mover_->take(gripped_, &why)) {
        case FragmentMover::Taken::yes:
            hold_ = Hold::drags;
            if (!grip_at_) grip_at_ = mover_->drag()->middle();
            waits_for_.clear();
            break;
        case FragmentMover::Taken::not_yet: waits_for_ = std::move(why); break;
        case FragmentMover::Taken::no:
            hold_ = Hold::ended;
            bench_.tell(fmt::format("not moved: {}", why), true);
            break;
    }
}

void ScenePanel::drag_fragment(int height) {
    const ImGuiIO& io = ImGui::GetIO();
    const Point total = point(ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, drag_begins_px));
    const Point by = total - std::exchange(dragged_, total);
    const Vec3 right = camera.orientation * Vec3(1.0, 0.0, 0.0), up = camera.orientation * Vec3(0.0, 1.0, 0.0),
               forward = camera.orientation * Vec3(0.0, 0.0, -1.0);
    const double per_pixel = size_of_pixel(camera, *grip_at_, height);
    mover_->let_attract(!io.KeyAlt);
    if (io.MouseWheel != 0.0f) mover_->move(forward * (static_cast<double>(io.MouseWheel) * 1e-3));
    if (by.x == 0.0 && by.y == 0.0) return;
    if (grip_ == Grip::shift) {
        // What the axis covers on the screen, pixels per metre.
        const Vec3 axis = along(grip_axis_);
        const Point way{glm::dot(axis, right) / per_pixel, -glm::dot(axis, up) / per_pixel};
        const double length2 = way.x * way.x + way.y * way.y;
        // One that points at the eye has no way on the screen.
        if (length2 * per_pixel * per_pixel > 0.01) mover_->move(axis * ((by.x * way.x + by.y * way.y) / length2));
    } else if (grip_ == Grip::turn) {
        const Point now = point(io.MousePos) - handles_at_, before = now - by;
        double angle = std::atan2(before.y, before.x) - std::atan2(now.y, now.x);
        angle -= 2.0 * std::numbers::pi * std::round(angle / (2.0 * std::numbers::pi));
        const Vec3 axis = along(grip_axis_);
        mover_->turn(axis * (glm::dot(axis, forward) < 0.0 ? angle : -angle));
    } else if (io.KeyCtrl) mover_->turn((up * by.x + right * by.y) * radians_per_pixel);
    else if (io.KeyShift) mover_->move(forward * (-by.y * per_pixel));
    else mover_->move((right * by.x - up * by.y) * per_pixel);
}

/// Arrows and rings at the middle of the fragment that was chosen last, and what a dragged one does.
void ScenePanel::draw_handles(const Painter& paint, Point corner, double pixel) {
    handles_.clear();
    if (!mover_ || hand_.has_mouse() || is_measuring || is_siting || screens_.tiles().empty()) return;
    const std::vector<int> chosen = chosen_places();
    if (chosen.empty()) return;
    const auto piece = model_->plan_pieces().find(static_cast<std::size_t>(chosen.back()));
    const SceneScreens::Tile& tile = screens_.tiles().front();
    if (piece == model_->plan_pieces().end() || tile.views.empty()) return;
    const Vec3 middle = piece->second.pose.position;
    const display::DrawnView& view = tile.views.front();
    const auto at = place_in(tile, view, middle, corner, pixel);
    if (!at) return;
    handles_at_ = *at;
    const Point far = corner + Point{tile.width * pixel, tile.height * pixel};
    paint.list()->PushClipRect(vec(corner), vec(far), true);
    const double size = size_of_pixel(camera, middle, static_cast<double>(tile.height) * pixel);
    const auto draw = [&](Grip grip, int axis, const std::string& name, auto place_of, int points) {
        Handle handle{grip, axis, {}};
        for (int n = 0; n <= points; ++n)
            if (const auto there = place_in(tile, view, place_of(n), corner, pixel)) handle.line.push_back(*there);
        const bool is_held = grip_ == grip && grip_axis_ == axis;
        for (std::size_t n = 1; n < handle.line.size(); ++n)
            paint.line(handle.line[n - 1], handle.line[n], colour_of_axis(axis), is_held ? 3.0 : 1.6);
        if (handle.line.empty()) return;
        const Point end = handle.line.back();
        if (grip == Grip::shift) paint.dot(end, is_held ? 5.0 : 4.0, colour_of_axis(axis));
        set_spot(name, {end.x - 1.0, end.y - 1.0, end.x + 1.0, end.y + 1.0});
        handles_.push_back(std::move(handle));
    };
    for (int axis = 0; axis < 3; ++axis) {
        const std::string name = axis_names[axis];
        const Vec3 first = along((axis + 1) % 3), second = along((axis + 2) % 3);
        draw(
            Grip::turn, axis, "turn handle " + name,
            [&](int n) {
                const double angle = 2.0 * std::numbers::pi * n / 32.0;
                return middle + ring_px * size * (std::cos(angle) * first + std::sin(angle) * second);
            },
            32);
        // From outside of the rings, which would be in the way.
        draw(
            Grip::shift, axis, "handle " + name,
            [&](int n) { return middle + size * (n == 0 ? ring_px : handle_px) * along(axis); }, 1);
    }
    paint.list()->PopClipRect();
    const FitCandidate* const fit = mover_->attraction();
    const std::string text = fit                                                  ? fmt::format("snaps: {}", fit->words)
                             : mover_->is_dragging() && mover_->drag()->touches() ? "touches"
                                                                                  : waits_for_;
    if (text.empty()) return;
    const double letters = 0.85 * static_cast<double>(ImGui::GetFontSize());
    const Point place{corner.x + 10.0, corner.y + 8.0};
    paint.text(place, letters, fit ? tone::good : tone::text, text);
    set_spot(fit                  ? "drag snaps"
             : waits_for_.empty() ? "drag touches"
                                  : "drag waits",
             {place.x, place.y, place.x + 1.0, place.y + letters});
}

}  // namespace tactus::window
