// SPDX-License-Identifier: Apache-2.0
// Tools of a scene: blades, spheres for hands, grippers.
#include "devices/display/shapes.hpp"
#include "tools/render/scene_colours.hpp"
#include "tools/render/scene_model.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus::render {

using namespace scene_colours;

namespace {

/// A place that is on the hand's side of a tool at any depth in a bone.
Vec3 hands_side_of(const Pose& tool) { return tool.apply({0.0, -0.2, 0.0}); }

}  // namespace

void SceneModel::show_blades() {
    for (const auto& blade : outline_.blades) {
        const auto pose = pose_of(blade.pose);
        if (!pose) continue;
        geometry::SurfacePatch patch;
        display::add_blade(patch, blade.shape, steel);
        // Margin for its motion.
        show(shape_mesh("blade " + blade.node, patch), *pose, display::bounds_of(patch), 1.0, false, false);
        tool_ = hands_side_of(*pose);
        // At the clamp of the blade: an arrow at the teeth would hide the cut.
        show_force(blade.wrench, pose->apply({-0.5 * blade.shape.length, -blade.shape.height, 0.0}));
    }
}

void SceneModel::show_balls() {
    for (std::size_t i = 0; i < outline_.fixed_balls.size(); ++i) {
        geometry::SurfacePatch patch;
        display::add_ball(patch, outline_.fixed_balls[i].centre, outline_.fixed_balls[i].radius, still_colour);
        show(shape_mesh(fmt::format("fixed ball {}", i), patch), {}, display::bounds_of(patch));
    }
    for (const auto& ball : outline_.balls) {
        geometry::SurfacePatch patch;
        const auto proxy = pose_of(ball.pose), hand = pose_of(ball.hand);
        if (hand) {
            display::add_ball(patch, Vec3(0.0), ball.radius, hand_colour);
            show(shape_mesh("hand of " + ball.pose, patch), *hand, display::bounds_of(patch), 1.0, false);
            legend_.entries.push_back({"hand", hand_colour});
        }
        if (!proxy) continue;
        patch = {};
        display::add_ball(patch, Vec3(0.0), ball.radius, proxy_colour);
        show(shape_mesh(ball.pose, patch), *proxy, display::bounds_of(patch), hand ? 0.75 : 1.0, false);
        legend_.entries.push_back({hand ? "proxy" : "tool", proxy_colour});
        if (!hand && !tool_) tool_ = hands_side_of(*proxy);
        show_force(ball.wrench, proxy->position, hand ? 0.0 : ball.radius);
    }
}

void SceneModel::show_gripper() {
    constexpr double opening = 50e-3;
    for (const auto& fingers : outline_.fingers) {
        const Pose hand = pose_of(fingers.hand).value_or(Pose{});
        const double finger = number_of(fingers.finger, 0.0), thumb = number_of(fingers.thumb, 0.0);
        geometry::SurfacePatch patch;
        display::add_box(patch, {-4e-3, -9e-3, -25e-3}, {4e-3, 9e-3, 25e-3}, steel);
        geometry::SurfacePatch body;
        display::add_box(body, {-45e-3, -14e-3, 25e-3}, {45e-3, 14e-3, 45e-3}, {0.42, 0.45, 0.50});
        const Vec3 left(-0.5 * opening - 4e-3 + thumb, 0.0, 0.0), right(0.5 * opening + 4e-3 - finger, 0.0, 0.0);
        show(shape_mesh("finger", patch), hand * Pose{left, {1.0, 0.0, 0.0, 0.0}}, display::bounds_of(patch), 1.0,
             false);
        show(shape_mesh("finger", patch), hand * Pose{right, {1.0, 0.0, 0.0, 0.0}}, display::bounds_of(patch), 1.0,
             false);
        show(shape_mesh("gripper", body), hand, display::bounds_of(body), 1.0, false);
        const double force = number_of(fingers.force, 0.0);
        legend_.entries.push_back({fmt::format("{}: {:.1f} mm closed", fingers.finger, finger * 1e3), steel});
        legend_.entries.push_back({fmt::format("{}: {:.1f} N", fingers.force, force), force_colour});
        // Drawn from outside, along the direction of the hand's force.
        const Vec3 at = hand.apply(right + Vec3(4e-3, 0.0, -10e-3)), along = hand.rotate(Vec3(1.0, 0.0, 0.0));
        if (std::abs(force) > 0.02) display::add_arrow(notes_, at + along * (force * 5e-3), at, 1.2e-3, force_colour);
    }
    for (const auto& weight : outline_.weights) {
        geometry::SurfacePatch patch;
        constexpr double half = 12e-3;
        display::add_box(patch, {-half, -half, -half}, {half, half, half}, group_colours[3]);
        geometry::SurfacePatch table;
        display::add_square(table, Vec3(0.0), {0.0, 0.0, 1.0}, 120e-3, {0.70, 0.72, 0.74}, 1.0);
        show(shape_mesh("table", table), {{0.0, 0.0, -10e-3 - half}, {1.0, 0.0, 0.0, 0.0}}, display::bounds_of(table));
        const double height = number_of(weight.height, 0.0);
        show(shape_mesh("weight", patch), {{0.0, 0.0, height - 10e-3}, {1.0, 0.0, 0.0, 0.0}}, display::bounds_of(patch),
             1.0, false);
        legend_.entries.push_back({fmt::format("weight, lifted by {:.1f} mm", height * 1e3), group_colours[3]});
    }
}

}  // namespace tactus::render
