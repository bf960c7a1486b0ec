// SPDX-License-Identifier: Apache-2.0
// Code common to the search for a site and its refinement.
#pragma once

#include "dsp/volume/grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace tactus::volume {

inline constexpr double deepest_site = 40e-3;  ///< m: a larger thickness of the bone is not measured
inline constexpr int site_directions = 8;  ///< of the blade about the feed

/// Interpolated value; `outside` beyond the grid.
inline double value_at(const Grid& grid, const Vec3& p, double outside) {
    const Vec3 u = (p - grid.origin) / grid.spacing;
    int cell[3];
    double t[3];
    for (int a = 0; a < 3; ++a) {
        if (!(u[a] >= 0.0 && u[a] <= grid.size[static_cast<std::size_t>(a)] - 1)) return outside;
        cell[a] = std::min(static_cast<int>(u[a]), grid.size[static_cast<std::size_t>(a)] - 2);
        t[a] = u[a] - cell[a];
    }
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const int dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
        const double weight = (dx ? t[0] : 1.0 - t[0]) * (dy ? t[1] : 1.0 - t[1]) * (dz ? t[2] : 1.0 - t[2]);
        sum += weight * static_cast<double>(grid.at(cell[0] + dx, cell[1] + dy, cell[2] + dz));
    }
    return sum;
}

/// One of eight directions orthogonal to the feed.
inline Vec3 site_direction(const Vec3& feed, int i) {
    // The reference axis is the one most nearly orthogonal to the feed, so that it is never parallel.
    const Vec3 size = glm::abs(feed);
    const Vec3 axis = size.x <= size.y && size.x <= size.z ? Vec3(1.0, 0.0, 0.0)
                      : size.y <= size.z                   ? Vec3(0.0, 1.0, 0.0)
                                                           : Vec3(0.0, 0.0, 1.0);
    const Vec3 first = glm::normalize(axis - feed * glm::dot(axis, feed)), second = glm::cross(feed, first);
    const double angle = std::numbers::pi * i / site_directions;
    return first * std::cos(angle) + second * std::sin(angle);
}

}  // namespace tactus::volume
