// SPDX-License-Identifier: Apache-2.0
// Swept-sphere test: when a moving ball first touches a triangle.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/geometry/closest_point.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::geometry {

namespace sweep_detail {

/// First t ≥ 0 at which |m + t·translation| equals `radius`; 2 when there is none.
inline double falls_to(const Vec3& m, const Vec3& translation, double radius) noexcept {
    const double a = glm::dot(translation, translation), b = glm::dot(m, translation),
                 c = glm::dot(m, m) - radius * radius;
    const double discriminant = b * b - a * c;
    if (!(a > 0.0) || b >= 0.0 || discriminant < 0.0) return 2.0;
    const double t = (-b - std::sqrt(discriminant)) / a;
    return t >= 0.0 ? t : 2.0;
}

}  // namespace sweep_detail

/// Fraction of the motion from `from` to `from` + `translation` at which a ball first touches triangle abc, 0 to 1; 2:
/// never. A ball that already overlaps the triangle touches it at 0 if it moves further in, and never if it moves out.
inline double ball_meets(const Vec3& from, const Vec3& translation, double radius, const Vec3& a, const Vec3& b,
                         const Vec3& c) noexcept {
    const Vec3 nearest = closest_on_triangle(from, a, b, c), out = from - nearest;
    const double distance2 = glm::dot(out, out);
    // The distance to a triangle is convex along a line: once it increases, it keeps increasing.
    const double approach = -glm::dot(translation, out);
    if (approach <= 0.0) return 2.0;
    if (distance2 <= radius * radius)
        return approach > 1e-6 * std::sqrt(glm::dot(translation, translation) * distance2) ? 0.0 : 2.0;
    const Vec3 n = glm::cross(b - a, c - a);
    const double area2 = glm::length(n);
    if (area2 > 0.0) {
        const double side = glm::dot(n, from - a) >= 0.0 ? 1.0 / area2 : -1.0 / area2;
        const double height = side * glm::dot(n, from - a), speed = -side * glm::dot(n, translation);
        if (height > radius && speed > 0.0) {
            const double t = (height - radius) / speed;
            const Vec3 foot = from + t * translation - radius * side * n;
            const bool within = glm::dot(glm::cross(b - a, foot - a), n) >= 0.0 &&
                                glm::dot(glm::cross(c - b, foot - b), n) >= 0.0 &&
                                glm::dot(glm::cross(a - c, foot - c), n) >= 0.0;
            if (within) return t <= 1.0 ? t : 2.0;
        }
    }
    double first = 2.0;
    const Vec3 corner[3] = {a, b, c};
    for (int e = 0; e < 3; ++e) {
        const Vec3 m = from - corner[e], d = corner[(e + 1) % 3] - corner[e];
        first = std::min(first, sweep_detail::falls_to(m, translation, radius));
        const double length2 = glm::dot(d, d);
        if (!(length2 > 0.0)) continue;
        const double start = glm::dot(m, d) / length2, slope = glm::dot(translation, d) / length2;
        const double t = sweep_detail::falls_to(m - start * d, translation - slope * d, radius);
        const double along = start + t * slope;
        if (t <= 1.0 && along >= 0.0 && along <= 1.0) first = std::min(first, t);
    }
    return first <= 1.0 ? first : 2.0;
}

}  // namespace tactus::geometry
