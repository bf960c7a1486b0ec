// SPDX-License-Identifier: Apache-2.0
// What guides a hand: guides, springs, pulls to a target, planned cuts with what they spare, readings.
#include "assets/training/task_file.hpp"
#include "devices/display/shapes.hpp"
#include "dsp/core/error.hpp"
#include "dsp/geometry/iso_surface.hpp"
#include "tools/render/scene_colours.hpp"
#include "tools/render/scene_model.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tactus::render {

using namespace scene_colours;

namespace {

constexpr double bar_radius = 0.4e-3, endless = 0.1, plane_side = 0.08, seen_through = 0.35;

/// A bar of square section.
void add_bar(geometry::SurfacePatch& patch, const Vec3& from, const Vec3& to, double radius, const Vec3& colour) {
    const double length = glm::length(to - from);
    if (!(length > 0.0)) return;
    const Vec3 z = (to - from) / length, side = std::abs(z.x) < 0.9 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    const Vec3 x = glm::normalize(glm::cross(side, z));
    const Quat turn = glm::normalize(glm::quat_cast(Mat3(x, glm::cross(z, x), z)));
    display::add_box(patch, {-radius, -radius, 0.0}, {radius, radius, length}, colour, {from, turn});
}

/// A ring around the y axis of a tool, which goes into the bone: what it surrounds stays in sight.
void add_ring(geometry::SurfacePatch& patch, const Pose& tool, double radius, const Vec3& colour) {
    constexpr int sides = 24;
    constexpr double thickness = 0.06;  // of the radius
    const auto at = [&](int n) {
        const double angle = 2.0 * std::numbers::pi * n / sides;
        return tool.apply(Vec3(radius * std::cos(angle), 0.0, radius * std::sin(angle)));
    };
    for (int n = 0; n < sides; ++n) add_bar(patch, at(n), at(n + 1), thickness * radius, colour);
}

void add_edges(geometry::SurfacePatch& patch, const Vec3& centre, const Vec3& size, double radius) {
    const auto corner = [&](std::size_t n) {
        return centre + 0.5 * size * Vec3(n & 1u ? 1.0 : -1.0, n & 2u ? 1.0 : -1.0, n & 4u ? 1.0 : -1.0);
    };
    for (std::size_t a = 0; a < 8; ++a)
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (const std::size_t b = a ^ (std::size_t{1} << axis); b > a)
                add_bar(patch, corner(a), corner(b), radius, guide_colour);
}

/// In its own frame. Opacity of a surface that is seen through, 1 of others.
double add_guide(geometry::SurfacePatch& patch, const Visual& guide) {
    switch (guide.kind) {
        case VisualKind::point: display::add_ball(patch, guide.at, 1e-3, guide_colour); return 1.0;
        case VisualKind::line: {
            const bool is_endless = !(guide.length > 0.0);
            add_bar(patch, guide.at - (is_endless ? endless : 0.0) * guide.direction,
                    guide.at + (is_endless ? endless : guide.length) * guide.direction, bar_radius, guide_colour);
            return 1.0;
        }
        case VisualKind::plane:
            display::add_square(patch, guide.at, guide.direction, plane_side, guide_colour, 1.0);
            return seen_through;
        case VisualKind::path:
            for (std::size_t i = 1; i < guide.points.size(); ++i)
                add_bar(patch, guide.points[i - 1], guide.points[i], bar_radius, guide_colour);
            return 1.0;
        case VisualKind::box: add_edges(patch, guide.at, guide.size, bar_radius); return 1.0;
        default: return 1.0;
    }
}

}  // namespace

void SceneModel::show_guides() {
    for (std::size_t i = 0; i < outline_.guides.size(); ++i) {
        const auto& [node, guide] = outline_.guides[i];
        const auto hand = pose_of(guide.hand);
        if (guide.kind == VisualKind::spring) {
            if (const auto end = pose_of(guide.pose); hand && end)
                add_bar(notes_, hand->position, end->position, bar_radius, guide_colour);
        } else {
            geometry::SurfacePatch patch;
            const double opacity = add_guide(patch, guide);
            // Guides without a force of their own, such as notches, belong to the one before.
            const bool is_first = i == 0 || outline_.guides[i - 1].node != node;
            if (is_first) is_guide_shown_ = is_part_shown(node, guide_colour);
            if (is_guide_shown_)
                show(shape_mesh(fmt::format("guide {}", i), patch), pose_of(guide.frame).value_or(Pose{}),
                     display::bounds_of(patch), opacity, false);
        }
        if (!hand) continue;
        display::add_axes(notes_, *hand, 0.01);
        show_force(guide.force, hand->position);
    }
    for (const auto& lead : outline_.leads) {
        const auto when = observer_.latest<bool>(lead.when);
        if (!when || !when->value) continue;
        const auto from = pose_of(lead.pose), to = pose_of(lead.target);
        if (from && to && glm::length(to->position - from->position) > 1e-3)
            display::add_arrow(notes_, from->position, to->position, 0.5e-3, hand_colour);
    }
    for (const auto& reading : outline_.readings) {
        const double value = number_of(reading.value, 0.0);
        const auto pose = pose_of(reading.pose);
        if (!pose || !(value > reading.limit)) continue;
        add_ring(notes_, *pose, reading.radius, heat_colour);
        legend_.entries.push_back(
            {fmt::format("{}: {:.3g} {} (ring)", reading.value, value, reading.unit), heat_colour});
    }
}

void SceneModel::show_tasks() {
    for (const auto& [node, path] : outline_.tasks) {
        auto known = tasks_.find(path);
        if (known == tasks_.end()) known = tasks_.emplace(path, make_task(path)).first;
        TaskMesh& task = known->second;
        if (!task.problem.empty()) legend_.warnings.push_back(task.problem);
        if (task.cut >= 0 && is_part_shown("planned cut", guide_colour)) {
            show(task.cut, {}, task.cut_bounds, seen_through, false);
            legend_.entries.push_back({"planned cut, down to its depth stop", guide_colour});
        }
        for (const auto& [name, mesh, bounds] : task.spared)
            if (is_part_shown(name, spared_colour)) {
                show(mesh, {}, bounds);
                legend_.entries.push_back({name + ", to be spared", spared_colour});
            }
    }
}

SceneModel::TaskMesh SceneModel::make_task(const std::string& path) {
    constexpr double widest = 0.03;  // of a cut without a guide, to both sides
    TaskMesh made;
    try {
        const training::Task task = training::load_task(path);
        geometry::SurfacePatch patch;
        // Both faces a little off the plane: at the same depth they would shimmer.
        constexpr double off = 0.05e-3;
        for (const training::PlannedCut& cut : task.cuts) {
            const double half = std::min(cut.half_length, widest);
            const Vec3 c = cut.position(half, cut.depth), d = cut.position(-half, cut.depth);
            for (const double side : {1.0, -1.0}) {
                const Vec3 a = cut.position(-half, 0.0, side * off), b = cut.position(half, 0.0, side * off),
                           e = cut.position(half, cut.depth, side * off),
                           f = cut.position(-half, cut.depth, side * off);
                const bool is_front = side > 0.0;
                display::add_triangle(patch, a, is_front ? b : e, is_front ? e : b, guide_colour);
                display::add_triangle(patch, a, is_front ? e : f, is_front ? f : e, guide_colour);
            }
            add_bar(patch, d, c, bar_radius, guide_colour);
        }
        made.cut = renderer_.meshes().make();
        made.cut_bounds = display::bounds_of(patch);
        renderer_.meshes().set_part(made.cut, 0, patch);
        for (const training::SparedStructure& spared : task.spared) {
            const geometry::TriangleSurface surface = geometry::iso_surface(spared.distance, 0.0f, false);
            geometry::SurfacePatch shape;
            for (const auto& t : surface.triangles)
                display::add_triangle(shape, surface.vertices[static_cast<std::size_t>(t[0])],
                                      surface.vertices[static_cast<std::size_t>(t[1])],
                                      surface.vertices[static_cast<std::size_t>(t[2])], spared_colour);
            made.spared.push_back({spared.name, renderer_.meshes().make(), display::bounds_of(shape)});
            renderer_.meshes().set_part(made.spared.back().mesh, 0, shape);
        }
    } catch (const Error& error) {
        made.problem = fmt::format("the task is not drawn: {}", error.message());
    }
    return made;
}

void SceneModel::remove(const TaskMesh& task) {
    if (task.cut >= 0) renderer_.meshes().remove(task.cut);
    for (const auto& spared : task.spared) renderer_.meshes().remove(spared.mesh);
}

}  // namespace tactus::render
