// SPDX-License-Identifier: Apache-2.0
#include "devices/display/shapes.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace tactus::display {

namespace {

constexpr int sides = 32;

std::uint32_t add_vertex(geometry::SurfacePatch& patch, const Vec3& at, const Vec3& normal, const Vec3& colour,
                         double opacity = 1.0) {
    patch.vertices.push_back({{static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)},
                              geometry::packed_normal(normal),
                              geometry::packed_colour(colour, opacity)});
    return static_cast<std::uint32_t>(patch.vertices.size() - 1);
}

/// An axis with two orthogonal directions.
struct Around {
    Vec3 axis, u, v;

    explicit Around(const Vec3& along) : axis(glm::normalize(along)) {
        const Vec3 across = std::abs(axis.x) < 0.7 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
        u = glm::normalize(glm::cross(axis, across));
        v = glm::cross(axis, u);
    }
    Vec3 out(int side) const {
        const double angle = 2.0 * std::numbers::pi * side / sides;
        return std::cos(angle) * u + std::sin(angle) * v;
    }
};

/// The band between two circles; a radius of 0 closes it. Faces outwards when `to` lies along the axis.
void add_band(geometry::SurfacePatch& patch, const Around& around, const Vec3& from, double from_radius, const Vec3& to,
              double to_radius, const Vec3& colour) {
    const double rise = glm::dot(to - from, around.axis), shrink = from_radius - to_radius;
    const bool is_disc = std::abs(rise) < 1e-12;
    const auto first = static_cast<std::uint32_t>(patch.vertices.size());
    for (int side = 0; side <= sides; ++side) {
        const Vec3 out = around.out(side);
        const Vec3 normal = is_disc ? around.axis * (shrink > 0.0 ? 1.0 : -1.0) : out * rise + around.axis * shrink;
        add_vertex(patch, from + out * from_radius, normal, colour);
        add_vertex(patch, to + out * to_radius, normal, colour);
    }
    for (std::uint32_t side = 0; side < sides; ++side) {
        const std::uint32_t a = first + 2 * side;
        patch.triangles.insert(patch.triangles.end(), {a, a + 2, a + 1, a + 1, a + 2, a + 3});
    }
}

}  // namespace

void add_triangle(geometry::SurfacePatch& patch, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& colour,
                  double opacity) {
    const Vec3 normal = glm::cross(b - a, c - a);
    for (const Vec3& corner : {a, b, c}) patch.triangles.push_back(add_vertex(patch, corner, normal, colour, opacity));
}

void add_ball(geometry::SurfacePatch& patch, const Vec3& centre, double radius, const Vec3& colour) {
    constexpr int rows = sides / 2;
    const auto first = static_cast<std::uint32_t>(patch.vertices.size());
    for (int row = 0; row <= rows; ++row)
        for (int side = 0; side <= sides; ++side) {
            const double polar = std::numbers::pi * row / rows, turn = 2.0 * std::numbers::pi * side / sides;
            const Vec3 out(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar));
            add_vertex(patch, centre + radius * out, out, colour);
        }
    for (std::uint32_t row = 0; row < rows; ++row)
        for (std::uint32_t side = 0; side < sides; ++side) {
            const std::uint32_t a = first + row * (sides + 1) + side, b = a + sides + 1;
            patch.triangles.insert(patch.triangles.end(), {a, b, a + 1, a + 1, b, b + 1});
        }
}

void add_box(geometry::SurfacePatch& patch, const Vec3& low, const Vec3& high, const Vec3& colour, const Pose& frame) {
    for (int axis = 0; axis < 3; ++axis)
        for (const bool far : {false, true}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            Vec3 corner[4];
            for (int n = 0; n < 4; ++n) {
                Vec3 at;
                at[axis] = far ? high[axis] : low[axis];
                at[u] = n == 1 || n == 2 ? high[u] : low[u];
                at[v] = n >= 2 ? high[v] : low[v];
                corner[n] = frame.apply(at);
            }
            const int b = far ? 1 : 3, d = far ? 3 : 1;
            add_triangle(patch, corner[0], corner[b], corner[2], colour);
            add_triangle(patch, corner[0], corner[2], corner[d], colour);
        }
}

void add_arrow(geometry::SurfacePatch& patch, const Vec3& from, const Vec3& to, double radius, const Vec3& colour) {
    const double length = glm::length(to - from);
    if (!is_finite(from) || !is_finite(to) || !(length > 0.0)) return;
    const Around around(to - from);
    const double head = 2.4 * radius;
    const Vec3 neck = to - around.axis * std::min(0.6 * length, 6.0 * radius);
    add_band(patch, around, from, 0.0, from, radius, colour);
    add_band(patch, around, from, radius, neck, radius, colour);
    add_band(patch, around, neck, radius, neck, head, colour);
    add_band(patch, around, neck, head, to, 0.0, colour);
}

void add_axes(geometry::SurfacePatch& patch, const Pose& pose, double length) {
    const Vec3 colours[] = {{0.80, 0.20, 0.18}, {0.25, 0.60, 0.25}, {0.20, 0.35, 0.80}};
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 along(0.0);
        along[axis] = length;
        add_arrow(patch, pose.position, pose.apply(along), 0.03 * length, colours[axis]);
    }
    add_ball(patch, pose.position, 0.06 * length, {0.35, 0.36, 0.38});
}

void add_blade(geometry::SurfacePatch& patch, const contact::BladeShape& shape, const Vec3& colour) {
    constexpr double pitch = 1.4e-3;  // 18 teeth per inch
    const int teeth = std::max(2, static_cast<int>(shape.length / pitch));
    const double tooth = shape.length / teeth, half = 0.5 * shape.thickness, root = -0.8 * tooth;
    add_box(patch, {-0.5 * shape.length, -shape.height, -half}, {0.5 * shape.length, root, half}, colour);
    for (int n = 0; n < teeth; ++n) {
        const double x = -0.5 * shape.length + n * tooth;
        const auto corner = [&](double u, double v, double z) { return Vec3(x + u * tooth, v, z); };
        // A tooth is a prism with its edge on the tooth line.
        add_triangle(patch, corner(0, root, half), corner(1, root, half), corner(0.5, 0, half), colour);
        add_triangle(patch, corner(1, root, -half), corner(0, root, -half), corner(0.5, 0, -half), colour);
        for (const double side : {0.0, 1.0}) {
            const double a = side == 0.0 ? half : -half;
            add_triangle(patch, corner(side, root, a), corner(0.5, 0, a), corner(0.5, 0, -a), colour);
            add_triangle(patch, corner(side, root, a), corner(0.5, 0, -a), corner(side, root, -a), colour);
        }
    }
}

void add_square(geometry::SurfacePatch& patch, const Vec3& centre, const Vec3& normal, double side, const Vec3& colour,
                double opacity) {
    const Around around(normal);
    const Vec3 u = 0.5 * side * around.u, v = 0.5 * side * around.v;
    add_triangle(patch, centre - u - v, centre + u - v, centre + u + v, colour, opacity);
    add_triangle(patch, centre - u - v, centre + u + v, centre - u + v, colour, opacity);
}

}  // namespace tactus::display
