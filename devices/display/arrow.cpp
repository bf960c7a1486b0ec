// SPDX-License-Identifier: Apache-2.0
#include "devices/display/offscreen.hpp"

#include <cmath>
#include <numbers>

namespace tactus {
namespace {

constexpr std::uint32_t sides = 24;

struct Frame {
    Vec3 u, v, axis;
    Vec3 radial(std::uint32_t side) const {
        const double angle = 2.0 * std::numbers::pi * static_cast<double>(side) / sides;
        return std::cos(angle) * u + std::sin(angle) * v;
    }
};

void add_vertex(PictureMesh& mesh, const Vec3& position, const Vec3& normal, const Vec3& colour) {
    for (int i = 0; i < 3; ++i) {
        mesh.positions.push_back(static_cast<float>(position[i]));
        mesh.normals.push_back(static_cast<float>(normal[i]));
        mesh.colours.push_back(static_cast<float>(colour[i]));
    }
}

/// The band between two circles around the axis; equal ends make a cylinder, a zero radius a cone or a disc.
void add_band(PictureMesh& mesh, const Frame& frame, const Vec3& from, double from_radius, const Vec3& to,
              double to_radius, const Vec3& colour) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size() / 3);
    const double rise = glm::dot(to - from, frame.axis);
    for (std::uint32_t side = 0; side <= sides; ++side) {
        const Vec3 out = frame.radial(side);
        const Vec3 normal =
            rise == 0.0 ? -frame.axis : glm::normalize(out * rise + frame.axis * (from_radius - to_radius));
        add_vertex(mesh, from + out * from_radius, normal, colour);
        add_vertex(mesh, to + out * to_radius, normal, colour);
    }
    for (std::uint32_t side = 0; side < sides; ++side) {
        const std::uint32_t a = first + 2 * side;
        mesh.triangles.insert(mesh.triangles.end(), {a, a + 2, a + 1, a + 1, a + 2, a + 3});
    }
}

}  // namespace

PictureMesh arrow_mesh(const Vec3& from, const Vec3& to, double radius, const Vec3& colour) {
    PictureMesh mesh;
    const double length = glm::length(to - from);
    if (!(length > 0.0)) return mesh;
    const Vec3 axis = (to - from) / length;
    const Vec3 across = std::abs(axis.x) < 0.7 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    const Vec3 u = glm::normalize(glm::cross(axis, across));
    const Frame frame{u, glm::cross(axis, u), axis};
    const double head_radius = 2.5 * radius;
    const Vec3 neck = to - axis * std::min(0.5 * length, 6.0 * radius);
    add_band(mesh, frame, from, 0.0, from, radius, colour);
    add_band(mesh, frame, from, radius, neck, radius, colour);
    add_band(mesh, frame, neck, radius, neck, head_radius, colour);
    add_band(mesh, frame, neck, head_radius, to, 0.0, colour);
    return mesh;
}

}  // namespace tactus
