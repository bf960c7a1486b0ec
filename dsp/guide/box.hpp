// SPDX-License-Identifier: Apache-2.0
// A box about the origin along the axes, as a wall from within or from without.
#pragma once

#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::guide {

struct WallContact {
    double depth = 0.0;        ///< m, 0: no contact
    Vec3 normal{0.0};          ///< to where the hand may be
};

/// Of a hand at `p` that must stay within ±`half`: the way back to the nearest point of the box.
inline WallContact outside_of(const Vec3& p, const Vec3& half) noexcept {
    const Vec3 out(p.x - std::clamp(p.x, -half.x, half.x), p.y - std::clamp(p.y, -half.y, half.y),
                   p.z - std::clamp(p.z, -half.z, half.z));
    const double depth = std::hypot(out.x, out.y, out.z);
    return depth > 0.0 ? WallContact{depth, out / -depth} : WallContact{};
}

/// Of a hand at `p` that must stay without: through the nearest face.
inline WallContact inside_of(const Vec3& p, const Vec3& half) noexcept {
    WallContact nearest;
    for (int axis = 0; axis < 3; ++axis) {
        const double depth = half[axis] - std::abs(p[axis]);
        if (!(depth > 0.0)) return {};
        if (nearest.depth > 0.0 && depth >= nearest.depth) continue;
        nearest = {depth, Vec3(0.0)};
        nearest.normal[axis] = p[axis] < 0.0 ? -1.0 : 1.0;
    }
    return nearest;
}

}  // namespace tactus::guide
