// SPDX-License-Identifier: Apache-2.0
#include "tools/window/paint/bone_panel.hpp"

#include "dsp/vessel/tube_surface.hpp"
#include "tools/render/triangle_patch.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

namespace tactus::window {

BonePanel::BonePanel(PaintBench& bench)
    : bench_(bench), making_(std::async(std::launch::async, [&bench] { return bone_mesh(bench.scan()); })) {}

std::optional<Point> BonePanel::place_of(const Vec3& position) const {
    if (!mesh_) return std::nullopt;
    const auto seen = camera_.projection(size_.x / size_.y, mesh_->bounds).seen(position);
    if (!seen) return std::nullopt;
    return corner_ + Point{0.5 * (seen->x + 1.0) * size_.x, 0.5 * (1.0 - seen->y) * size_.y};
}

/// Of the line of sight through a pixel of the window.
Vec3 BonePanel::direction_at(Point pixel) const {
    const Point p = pixel - corner_;
    const double half = std::tan(0.5 * camera_.vertical_field_of_view_rad);
    const Vec3 in_eye((2.0 * p.x / size_.x - 1.0) * half * size_.x / size_.y, (1.0 - 2.0 * p.y / size_.y) * half, -1.0);
    return glm::normalize(camera_.orientation * in_eye);
}

/// The bone under a pixel of the window.
std::optional<Vec3> BonePanel::surface_at(Point pixel) const {
    Vec3 found;
    if (!bench_.first_bone(camera_.eye(), direction_at(pixel), found)) return std::nullopt;
    return found;
}

void BonePanel::use_tool(Point) {
    Painting& painting = bench_.painting();
    const Point mouse = point(ImGui::GetIO().MousePos);
    if (ImGui::IsItemClicked(ImGuiMouseButton_Left) && bench_.tool == PaintBench::Tool::vessel) {
        bench_.follow_vessel_on(camera_.eye(), direction_at(mouse));
        return;
    }
    if (ImGui::IsItemClicked(ImGuiMouseButton_Left)) {
        const auto at = surface_at(mouse);
        if (!at) return;
        bench_.move_cursor(*at);
        painting.begin(bench_.brush, *at, bench_.tool == PaintBench::Tool::erase);
    }
    if (!painting.is_open()) return;
    if (ImGui::IsItemActive()) {
        if (const auto at = surface_at(mouse)) {
            // Not across a gap that is only seen from this side.
            if (glm::length(*at - painting.open_stroke().points.back()) < 4.0 * bench_.brush) painting.extend(*at);
        }
        if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) painting.end();
    } else if (ImGui::IsItemDeactivated()) painting.end();
}

void BonePanel::steer(Point size) {
    if (!ImGui::IsItemHovered() && !ImGui::IsItemActive()) return;
    const ImGuiIO& io = ImGui::GetIO();
    const Point by = point(io.MouseDelta);
    if (ImGui::IsMouseDragging(ImGuiMouseButton_Right, 1.0f))
        camera_.orbit(-by.x * 2.0 * std::numbers::pi / size.x, by.y * std::numbers::pi / size.y);
    else if (ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 1.0f)) camera_.pan(by.x / size.y, -by.y / size.y);
    if (io.MouseWheel != 0.0f) camera_.zoom(std::pow(1.15, static_cast<double>(io.MouseWheel)));
}

void BonePanel::add_vessels() {
    for (; vessels_ < bench_.vessels().size(); ++vessels_)
        for (const vessel::Branch& branch : bench_.vessels()[vessels_]->track.branches) {
            const geometry::SurfacePatch patch =
                render::triangle_patch(vessel::tube_surface(branch), {214, 48, 49, 255});
            if (patch.triangles.empty()) continue;
            display::DrawnMesh drawn;
            drawn.mesh = renderer_->meshes().make();
            drawn.is_closed = true;
            drawn.shines_through = true;
            renderer_->meshes().set_part(drawn.mesh, 0, patch);
            picture_.meshes.push_back(drawn);
            picture_.bounds.add(display::bounds_of(patch));
        }
}

void BonePanel::render(int width, int height) {
    if (!renderer_) {
        renderer_ = std::make_unique<display::SceneRenderer>();
        bone_ = renderer_->meshes().make();
        display::DrawnMesh drawn;
        drawn.mesh = bone_;
        drawn.is_closed = true;
        picture_.meshes = {drawn};
        picture_.bounds = mesh_->bounds;
        picture_.sky = Vec3(0.16, 0.18, 0.22);
        picture_.ground = Vec3(0.09, 0.10, 0.13);
    }
    if (!is_aimed_) {
        camera_.fit(mesh_->bounds, static_cast<double>(width) / height);
        is_aimed_ = true;
    }
    std::string colours = fmt::format("{}", bench_.labels() ? bench_.labels()->number : 0);
    for (const auto& c : bench_.colours()) colours += fmt::format(" {}.{}.{}", c[0], c[1], c[2]);
    if (colours != coloured_) {
        coloured_ = colours;
        colour_mesh(*mesh_, bench_.labels().get(), bench_.colours());
        renderer_->meshes().set_part(bone_, 0, mesh_->patch);
    }
    add_vessels();
    const Vec3 eye = camera_.eye(), up = camera_.orientation * Vec3(0.0, 1.0, 0.0);
    const Vec3& c = bench_.cursor;
    const std::string wanted =
        fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {} {}", coloured_, vessels_, width, height, eye.x, eye.y,
                    eye.z, up.x, up.y, up.z, camera_.target.x, c.x, c.y, c.z);
    if (wanted == shown_) return;
    shown_ = wanted;
    geometry::SurfaceVertex dot;
    for (int axis = 0; axis < 3; ++axis)
        dot.position[static_cast<std::size_t>(axis)] = static_cast<float>(bench_.cursor[axis]);
    dot.colour = {90, 176, 255, 255};
    picture_.points = {dot};
    target_.begin(width, height, renderer_->is_software() ? 1 : 4);
    const display::DrawnView view{camera_.projection(static_cast<double>(width) / height, picture_.bounds), 0, 0, width,
                                  height};
    renderer_->draw(picture_, {&view, 1});
    target_.end();
}

void BonePanel::draw(const Fonts& fonts) {
    corner_ = point(ImGui::GetCursorScreenPos());
    size_ = point(ImGui::GetContentRegionAvail());
    if (size_.x < 8.0 || size_.y < 8.0) return;
    const Painter paint(ImGui::GetWindowDrawList(), fonts);
    if (!mesh_ && making_.valid() && making_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
        mesh_ = making_.get();
    ImGui::InvisibleButton(
        "bone", vec(size_),
        ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
    mark_spot("bone");
    if (!mesh_) {
        paint.text(corner_ + Point{8.0, 6.0}, 12.0 * fonts.scale, tone::dim, "the surface is being made");
        return;
    }
    steer(size_);
    use_tool(corner_);
    const double dense = std::max(1.0, static_cast<double>(ImGui::GetIO().DisplayFramebufferScale.x));
    render(static_cast<int>(size_.x * dense), static_cast<int>(size_.y * dense));
    paint.list()->AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(target_.texture())), vec(corner_),
                           vec(corner_ + size_), ImVec2(0, 1), ImVec2(1, 0));
    const Painting& painting = bench_.painting();
    if (painting.is_open())
        for (const Vec3& p : painting.open_stroke().points)
            if (const auto at = place_of(p)) paint.dot(*at, 3.0 * fonts.scale, tone::chosen);
    paint.text(corner_ + Point{8.0, 6.0}, 12.0 * fonts.scale, tone::dim,
               bench_.tool == PaintBench::Tool::vessel
                   ? "left: the first vessel on the line of sight, unless bone lies before it; right: turn"
                   : "right: turn, middle: move, wheel: zoom");
    if (bench_.labels() && bench_.labels()->is_preview)
        paint.text_left_of(corner_ + Point{size_.x - 6.0, 6.0}, 12.0 * fonts.scale, tone::warm, "preview");
}

}  // namespace tactus::window
