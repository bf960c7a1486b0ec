// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/shape.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::contact {

namespace {

int parts(double length, double spacing) { return std::max(1, static_cast<int>(std::ceil(length / spacing - 1e-9))); }

}  // namespace

volume::Grid centred_layout(int samples_per_side, double spacing) {
    const int n = samples_per_side;
    return {{n, n, n}, Vec3(-0.5 * (n - 1) * spacing), Vec3(spacing), {}};
}

volume::Grid layout_around(const Vec3& low, const Vec3& high, double spacing, double margin) {
    volume::Grid grid{{}, low - Vec3(margin), Vec3(spacing), {}};
    const Vec3 extent = high + Vec3(margin) - grid.origin;
    for (int axis = 0; axis < 3; ++axis)
        grid.size[static_cast<std::size_t>(axis)] = static_cast<int>(std::ceil(extent[axis] / spacing)) + 1;
    return grid;
}

std::vector<SurfacePoint> spread_over_ball(int count, double radius) {
    std::vector<SurfacePoint> points;
    const double turn = std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double area = 4.0 * std::numbers::pi * radius * radius / count;
    for (int i = 0; i < count; ++i) {
        const double z = 1.0 - (2.0 * i + 1.0) / count, ring = std::sqrt(1.0 - z * z);
        const Vec3 n(ring * std::cos(turn * i), ring * std::sin(turn * i), z);
        points.push_back({radius * n, n, area, surface_label::none});
    }
    return points;
}

double Ball::distance(const Vec3& p) const { return glm::length(p) - radius; }

std::vector<SurfacePoint> Ball::points(double spacing) const {
    // Points of a triangular lattice represent √3/2 of their spacing squared.
    const double area = 4.0 * std::numbers::pi * radius * radius;
    return spread_over_ball(std::max(4, static_cast<int>(area / (0.866 * spacing * spacing))), radius);
}

double Box::distance(const Vec3& p) const {
    const Vec3 q = glm::abs(p) - 0.5 * size;
    return glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

std::vector<SurfacePoint> Box::points(double spacing) const {
    int n[3];
    for (int axis = 0; axis < 3; ++axis) n[axis] = parts(size[axis], spacing);
    std::vector<SurfacePoint> all;
    for (int k = 0; k <= n[2]; ++k)
        for (int j = 0; j <= n[1]; ++j)
            for (int i = 0; i <= n[0]; ++i) {
                const int at[3] = {i, j, k};
                SurfacePoint point{Vec3(0.0), Vec3(0.0), 0.0, surface_label::none};
                double share[3], cell[3];
                for (int axis = 0; axis < 3; ++axis) {
                    point.position[axis] = size[axis] * (static_cast<double>(at[axis]) / n[axis] - 0.5);
                    const bool first = at[axis] == 0, last = at[axis] == n[axis];
                    point.normal[axis] = (last ? 1.0 : 0.0) - (first ? 1.0 : 0.0);
                    share[axis] = first || last ? 0.5 : 1.0;
                    cell[axis] = size[axis] / n[axis];
                }
                if (point.normal == Vec3(0.0)) continue;
                for (int axis = 0; axis < 3; ++axis) {
                    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
                    if (point.normal[axis] != 0.0) point.area += share[u] * cell[u] * share[v] * cell[v];
                }
                point.normal = glm::normalize(point.normal);
                all.push_back(point);
            }
    return all;
}

double Revolved::distance(const Vec3& p) const {
    const glm::dvec2 q(std::hypot(p.x, p.y), p.z);
    double nearest = std::numeric_limits<double>::infinity();
    bool inside = false;
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const glm::dvec2 a = profile[i], b = profile[(i + 1) % profile.size()], ab = b - a;
        if ((a.y > q.y) != (b.y > q.y) && q.x < a.x + (q.y - a.y) / ab.y * ab.x) inside = !inside;
        // An edge on the axis is inside the solid.
        if (a.x == 0.0 && b.x == 0.0) continue;
        const double length2 = glm::dot(ab, ab);
        const double t = length2 > 0.0 ? std::clamp(glm::dot(q - a, ab) / length2, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, glm::length(q - a - t * ab));
    }
    return inside ? -nearest : nearest;
}

std::vector<SurfacePoint> Revolved::points(double spacing) const {
    std::vector<SurfacePoint> all;
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const glm::dvec2 a = profile[i], b = profile[(i + 1) % profile.size()], ab = b - a;
        const double length = glm::length(ab);
        if ((a.x == 0.0 && b.x == 0.0) || length == 0.0) continue;
        const glm::dvec2 out(ab.y / length, -ab.x / length);
        const int rings = parts(length, spacing);
        // Rings start at each corner, where two edges meet, and end one ring before the next corner.
        const bool closes = b.x == 0.0;
        for (int r = 0; r < rings + (closes ? 1 : 0); ++r) {
            const glm::dvec2 at = a + ab * (static_cast<double>(r) / rings);
            const int count = std::max(1, static_cast<int>(std::lround(2.0 * std::numbers::pi * at.x / spacing)));
            for (int c = 0; c < count; ++c) {
                const double angle = 2.0 * std::numbers::pi * (c + 0.5 * (r & 1)) / count;
                const double cosine = std::cos(angle), sine = std::sin(angle);
                const double area = std::max(2.0 * std::numbers::pi * at.x, spacing) * length / rings / count;
                all.push_back({Vec3(at.x * cosine, at.x * sine, at.y), Vec3(out.x * cosine, out.x * sine, out.y), area,
                               surface_label::none});
            }
        }
    }
    return all;
}

Vec3 Revolved::low() const {
    Vec3 corner(0.0, 0.0, std::numeric_limits<double>::infinity());
    for (const auto& p : profile) corner = glm::min(corner, Vec3(-p.x, -p.x, p.y));
    return corner;
}

Vec3 Revolved::high() const {
    Vec3 corner(0.0, 0.0, -std::numeric_limits<double>::infinity());
    for (const auto& p : profile) corner = glm::max(corner, Vec3(p.x, p.x, p.y));
    return corner;
}

Revolved make_cylinder(double diameter, double height, double bevel) {
    const double r = 0.5 * diameter;
    Revolved body{{{0.0, 0.0}, {r - bevel, 0.0}, {r, bevel}, {r, height}, {0.0, height}}};
    if (bevel <= 0.0) body.profile.erase(body.profile.begin() + 1);
    return body;
}

Revolved make_bushing(double bore, double diameter, double height, double bevel) {
    const double in = 0.5 * bore, out = 0.5 * diameter;
    Revolved body{{{out, 0.0}, {in + bevel, 0.0}, {in, -bevel}, {in, -height}, {out, -height}}};
    if (bevel <= 0.0) body.profile.erase(body.profile.begin() + 1);
    return body;
}

}  // namespace tactus::contact
