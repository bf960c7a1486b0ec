// SPDX-License-Identifier: Apache-2.0
// Where a clip plane lies in a scene: by its share of the scene's extent along the normal.
#pragma once

#include "devices/display/scene_renderer.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace tactus::window {

/// Least and largest place of a box along a direction of length 1, m.
inline std::array<double, 2> extent_along(const display::Bounds& bounds, const Vec3& direction) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& corner : bounds.corners()) {
        low = std::min(low, glm::dot(corner, direction));
        high = std::max(high, glm::dot(corner, direction));
    }
    return {low, high};
}

/// The share at which a plane goes through a point.
inline double share_through(const display::Bounds& bounds, const Vec3& normal, const Vec3& point) {
    const auto [low, high] = extent_along(bounds, normal);
    return high > low ? (glm::dot(point, normal) - low) / (high - low) : 0.5;
}

inline display::Plane plane_at(const display::Bounds& bounds, const Vec3& normal, double share) {
    const auto [low, high] = extent_along(bounds, normal);
    const Vec3 middle = 0.5 * (bounds.low + bounds.high);
    return {middle + normal * (low + share * (high - low) - glm::dot(middle, normal)), normal};
}

}  // namespace tactus::window
