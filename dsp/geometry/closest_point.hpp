// SPDX-License-Identifier: Apache-2.0
// Closest point on a triangle.
#pragma once

#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::geometry {

inline Vec3 closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 ab = b - a;
    const double length2 = glm::dot(ab, ab);
    return length2 > 0.0 ? a + std::clamp(glm::dot(p - a, ab) / length2, 0.0, 1.0) * ab : a;
}

/// Closest point on triangle abc to p: on the face when p projects into it, otherwise on an edge. A degenerate triangle
/// is treated as its edges.
inline Vec3 closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double g11 = glm::dot(ab, ab), g12 = glm::dot(ab, ac), g22 = glm::dot(ac, ac);
    const double r1 = glm::dot(ap, ab), r2 = glm::dot(ap, ac);
    const double det = g11 * g22 - g12 * g12;
    if (det > 1e-12 * g11 * g22) {
        const double u = (g22 * r1 - g12 * r2) / det, v = (g11 * r2 - g12 * r1) / det;
        if (u >= 0.0 && v >= 0.0 && u + v <= 1.0) return a + u * ab + v * ac;
    }
    const auto nearer = [&p](const Vec3& x, const Vec3& y) {
        return glm::dot(x - p, x - p) <= glm::dot(y - p, y - p) ? x : y;
    };
    return nearer(nearer(closest_on_segment(p, a, b), closest_on_segment(p, b, c)), closest_on_segment(p, c, a));
}

}  // namespace tactus::geometry
