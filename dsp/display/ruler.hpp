// SPDX-License-Identifier: Apache-2.0
// Lengths and angles between picked points.
#pragma once

#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

namespace tactus::display {

/// Along the points, one after another, m; 0 for fewer than two.
inline double path_length(std::span<const Vec3> points) {
    double length = 0.0;
    for (std::size_t i = 1; i < points.size(); ++i) length += glm::length(points[i] - points[i - 1]);
    return length;
}

/// Between the two legs that meet at `vertex`, 0 to π rad. None when a leg has no length.
inline std::optional<double> angle_at(const Vec3& vertex, const Vec3& a, const Vec3& b) {
    const Vec3 u = a - vertex, v = b - vertex;
    if (!(glm::length(u) > 0.0) || !(glm::length(v) > 0.0)) return std::nullopt;
    // Right also for angles near 0 and π, where the cosine is flat.
    return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

}  // namespace tactus::display
