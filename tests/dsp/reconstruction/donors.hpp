// SPDX-License-Identifier: Apache-2.0
// Donor bones with known shapes.
#pragma once

#include "dsp/core/constants.hpp"
#include "dsp/core/types.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <functional>
#include <numbers>

namespace tactus::reconstruction {

/// An open tube about the line: `radius`(turn in rad, place in m) in m; `bow` moves its centre aside.
inline geometry::TriangleSurface tube_of(
    const Vec3& from, const Vec3& axis, double length, int round, int rings,
    const std::function<double(double, double)>& radius,
    const std::function<Vec3(double)>& bow = [](double) { return Vec3(0.0); }) {
    geometry::TriangleSurface out;
    const Vec3 side = glm::normalize(glm::cross(axis, Vec3(0.3, 1.0, 0.2))), other = glm::cross(axis, side);
    for (int ring = 0; ring < rings; ++ring)
        for (int n = 0; n < round; ++n) {
            const double a = 2.0 * std::numbers::pi * n / round, s = length * ring / (rings - 1);
            const Vec3 aside = bow(s);
            out.vertices.push_back(from + axis * s + aside.x * side + aside.y * other +
                                   radius(a, s) * (std::cos(a) * side + std::sin(a) * other));
        }
    const auto at = [round](int ring, int n) { return ring * round + n % round; };
    for (int ring = 0; ring + 1 < rings; ++ring)
        for (int n = 0; n < round; ++n) {
            out.triangles.push_back({at(ring, n), at(ring, n + 1), at(ring + 1, n)});
            out.triangles.push_back({at(ring, n + 1), at(ring + 1, n + 1), at(ring + 1, n)});
        }
    return out;
}

/// The same, closed at both ends.
inline geometry::TriangleSurface closed_tube(const Vec3& from, const Vec3& axis, double length, int round, int rings,
                                             const std::function<double(double, double)>& radius) {
    geometry::TriangleSurface out = tube_of(from, axis, length, round, rings, radius);
    const int low = static_cast<int>(out.vertices.size()), first = (rings - 1) * round;
    out.vertices.push_back(from);
    out.vertices.push_back(from + axis * length);
    for (int n = 0; n < round; ++n) {
        out.triangles.push_back({low, (n + 1) % round, n});
        out.triangles.push_back({low + 1, first + n, first + (n + 1) % round});
    }
    return out;
}

inline void append(geometry::TriangleSurface& to, const geometry::TriangleSurface& more) {
    const int first = static_cast<int>(to.vertices.size());
    to.vertices.insert(to.vertices.end(), more.vertices.begin(), more.vertices.end());
    for (const auto& t : more.triangles) to.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

/// A fibula of 330 mm with three edges, a bow of 4 mm and a marrow cavity, and a tibia 40 mm beside it that reaches
/// farther up and down.
inline geometry::TriangleSurface lower_leg(const Vec3& from, const Vec3& axis) {
    constexpr double length = 330.0 * mm;
    const auto bow = [](double s) { return Vec3(4.0 * mm * std::sin(std::numbers::pi * s / length), 0.0, 0.0); };
    geometry::TriangleSurface leg = tube_of(
        from, axis, length, 36, 61,
        [](double a, double s) { return (7.0 + 1.2 * std::cos(3.0 * a) + 0.5 * std::sin(s / (40.0 * mm))) * mm; }, bow);
    append(leg, tube_of(
                    from + axis * (30.0 * mm), axis, 270.0 * mm, 16, 41, [](double, double) { return 3.0 * mm; },
                    [&](double s) { return bow(s + 30.0 * mm); }));
    append(leg, tube_of(
                    from - axis * (20.0 * mm), axis, 390.0 * mm, 20, 20, [](double, double) { return 14.0 * mm; },
                    [](double) { return Vec3(0.0, 40.0 * mm, 0.0); }));
    return leg;
}

}  // namespace tactus::reconstruction
