// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/blade.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus {

BladePoints::BladePoints(const BladeShape& shape) {
    for (int i = 0; i < blade_row; ++i) {
        const double x = shape.length * (static_cast<double>(i) / (blade_row - 1) - 0.5);
        const auto at = static_cast<std::size_t>(i);
        local[at] = Vec3(x, 0.0, 0.0);
        local[at + blade_row] = Vec3(x, -0.5 * shape.height, 0.5 * shape.thickness);
        local[at + 2 * blade_row] = Vec3(x, -0.5 * shape.height, -0.5 * shape.thickness);
    }
}

BladeContact blade_contact(const BoneSnapshot& bone, const BladePoints& blade, const Pose& tool, const Vec3& about,
                           double stiffness) noexcept {
    BladeContact contact;
    if (!is_valid(tool)) return contact;
    struct Touch {
        Vec3 position, gradient;
        double depth;
    };
    std::array<Touch, blade_point_count> touches;
    for (const Vec3& local : blade.local) {
        const Vec3 position = tool.apply(local);
        const Sample sample = bone.sample(position);
        if (!sample.inside || sample.value >= 0.0) continue;
        touches[static_cast<std::size_t>(contact.count++)] = {position, sample.gradient, -sample.value};
        contact.penetration = std::max(contact.penetration, -sample.value);
    }
    if (contact.count == 0) return contact;
    // Depths relative to the deepest: their eighth powers neither overflow nor vanish.
    double sum = 0.0;
    for (int i = 0; i < contact.count; ++i) {
        const double r = touches[static_cast<std::size_t>(i)].depth / contact.penetration;
        const double r4 = r * r * r * r;
        sum += r4 * r4;
    }
    constexpr double margin = 4.0;
    const double norm = std::sqrt(std::sqrt(std::sqrt(sum)));  // ‖d‖₈ in units of the deepest
    for (int i = 0; i < contact.count; ++i) {
        const Touch& touch = touches[static_cast<std::size_t>(i)];
        const double r = touch.depth / (contact.penetration * norm);
        const Vec3 force = touch.gradient * (stiffness / margin * (r * r * r) * (r * r * r) * touch.depth);
        contact.wrench.force += force;
        contact.wrench.torque += glm::cross(touch.position - about, force);
    }
    contact.load = std::max(0.0, -glm::dot(contact.wrench.force, tool.rotate(Vec3(0.0, 1.0, 0.0))));
    return contact;
}

}  // namespace tactus
