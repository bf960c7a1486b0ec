// SPDX-License-Identifier: Apache-2.0
// Volume enclosed by a surface.
#pragma once

#include "dsp/geometry/iso_surface.hpp"

#include <glm/geometric.hpp>

#include <cstddef>

namespace tactus::geometry {

/// m³, positive if triangles face outwards; the surface must be closed.
inline double volume_of(const TriangleSurface& surface) {
    if (surface.vertices.empty()) return 0.0;
    const Vec3 base = surface.vertices.front();  // near the surface, to avoid cancellation
    double six = 0.0;
    for (const auto& t : surface.triangles) {
        const auto from_base = [&](std::size_t n) { return surface.vertices[static_cast<std::size_t>(t[n])] - base; };
        six += glm::dot(from_base(0), glm::cross(from_base(1), from_base(2)));
    }
    return six / 6.0;
}

}  // namespace tactus::geometry
