// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/blade.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace tactus::contact {

BladePoints::BladePoints(const BladeShape& shape) {
    for (int i = 0; i < blade_row; ++i) {
        const double x = shape.length * (static_cast<double>(i) / (blade_row - 1) - 0.5);
        const auto at = static_cast<std::size_t>(i);
        local[at] = Vec3(x, 0.0, 0.0);
        local[at + blade_row] = Vec3(x, -0.5 * shape.height, 0.5 * shape.thickness);
        local[at + 2 * blade_row] = Vec3(x, -0.5 * shape.height, -0.5 * shape.thickness);
    }
}

namespace {

// Largest curvature of ½‖d‖₈² over 44 depths that change in the same direction, and over 88 of which half change in the
// opposite direction: 7·88^(1/4) = 21.4.
constexpr double edge_margin = 4.0, face_margin = 22.0;

struct Touch {
    Vec3 position, gradient;
    double depth;
};

/// Adds the forces of the energy ½·k·‖d‖₈² over the given points.
void push(std::span<const Touch> touches, double k, const Vec3& about, Wrench& into) noexcept {
    double deepest = 0.0;
    for (const Touch& touch : touches) deepest = std::max(deepest, touch.depth);
    if (deepest <= 0.0) return;
    // Depths relative to the maximum: their eighth powers neither overflow nor underflow.
    double sum = 0.0;
    for (const Touch& touch : touches) {
        const double r = touch.depth / deepest, r4 = r * r * r * r;
        sum += r4 * r4;
    }
    const double norm = deepest * std::sqrt(std::sqrt(std::sqrt(sum)));
    for (const Touch& touch : touches) {
        const double r = touch.depth / norm, r3 = r * r * r;
        const Vec3 force = touch.gradient * (k * r3 * r3 * touch.depth);
        into.force += force;
        into.torque += glm::cross(touch.position - about, force);
    }
}

}  // namespace

BladeContact blade_contact(const volume::BoneSnapshot& bone, const BladePoints& blade, const Pose& tool,
                           const Vec3& about, double stiffness) noexcept {
    BladeContact contact;
    if (!is_valid(tool)) return contact;
    std::array<Touch, blade_point_count> touches;
    int edge = 0;  // points of the tooth edge come first
    const Vec3& spacing = bone.layout().spacing;
    const double reach = std::min(bone.layout().far, std::max({spacing.x, spacing.y, spacing.z}));
    for (std::size_t i = 0; i < blade.local.size(); ++i) {
        const Vec3 position = tool.apply(blade.local[i]);
        // The B-spline can be negative only where the cheap interpolated value is small.
        if (!(bone.value(position) < reach)) continue;
        const volume::Sample sample = bone.smooth_sample(position);
        if (!sample.inside || sample.value >= 0.0) continue;
        touches[static_cast<std::size_t>(contact.count++)] = {position, sample.gradient, -sample.value};
        contact.penetration = std::max(contact.penetration, -sample.value);
        edge += i < blade_row;
    }
    if (contact.count == 0) return contact;
    const auto all = std::span<const Touch>(touches).first(static_cast<std::size_t>(contact.count));
    push(all.first(static_cast<std::size_t>(edge)), stiffness / edge_margin, about, contact.wrench);
    push(all.subspan(static_cast<std::size_t>(edge)), stiffness / face_margin, about, contact.wrench);
    contact.load = std::max(0.0, -glm::dot(contact.wrench.force, tool.rotate(Vec3(0.0, 1.0, 0.0))));
    return contact;
}

}  // namespace tactus::contact
