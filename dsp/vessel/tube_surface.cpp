// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/tube_surface.hpp"

#include <glm/geometric.hpp>

#include <numbers>

namespace tactus::vessel {

geometry::TriangleSurface tube_surface(const Branch& branch, int sides) {
    geometry::TriangleSurface surface;
    if (branch.nodes.size() < 2) return surface;
    Vec3 side = across(branch.nodes.front().direction).first;
    for (const Node& node : branch.nodes) {
        side -= glm::dot(side, node.direction) * node.direction;
        side = glm::length(side) > 1e-6 ? glm::normalize(side) : across(node.direction).first;
        const Vec3 other = glm::cross(node.direction, side);
        for (int n = 0; n < sides; ++n) {
            const double angle = 2.0 * std::numbers::pi * n / sides;
            surface.vertices.push_back(node.position +
                                       node.radius * (std::cos(angle) * side + std::sin(angle) * other));
        }
    }
    const int rings = static_cast<int>(branch.nodes.size());
    const auto corner = [&](int ring, int n) { return ring * sides + n % sides; };
    const int start = static_cast<int>(surface.vertices.size()), end = start + 1;
    surface.vertices.push_back(branch.nodes.front().position);
    surface.vertices.push_back(branch.nodes.back().position);
    for (int n = 0; n < sides; ++n) {
        surface.triangles.push_back({start, corner(0, n + 1), corner(0, n)});
        for (int ring = 0; ring + 1 < rings; ++ring) {
            surface.triangles.push_back({corner(ring, n), corner(ring, n + 1), corner(ring + 1, n)});
            surface.triangles.push_back({corner(ring, n + 1), corner(ring + 1, n + 1), corner(ring + 1, n)});
        }
        surface.triangles.push_back({end, corner(rings - 1, n), corner(rings - 1, n + 1)});
    }
    return surface;
}

}  // namespace tactus::vessel
