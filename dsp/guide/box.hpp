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

/// Of a hand at `p` that must stay without, and how much of the wall's force it feels.
struct RoundedContact {
    double depth = 0.0;  ///< m, a mean of the depths below all faces to which the least contributes most
    Vec3 normal{0.0};    ///< to where the hand may be, of length 1
    double share = 0.0;  ///< from 0 to 1: length of the depth's gradient
};

/// Through the nearest face; where two are nearly as near, the normal turns from one to the other. The depth is
/// (Σ 1/depth⁴)^(-1/4) over the six faces: close to a face it is that face's, and a spring on it is the slope of an
/// energy that bends nowhere by more than 3.6 times the spring's stiffness.
inline RoundedContact rounded_inside_of(const Vec3& p, const Vec3& half) noexcept {
    double least = half.x;
    for (int axis = 0; axis < 3; ++axis) least = std::min(least, half[axis] - std::abs(p[axis]));
    if (!(least > 0.0)) return {};
    double sum = 0.0;
    Vec3 gradient(0.0);
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const double nearness = least / (half[axis] - side * p[axis]), squared = nearness * nearness;
            sum += squared * squared;
            gradient[axis] += side * squared * squared * nearness;
        }
    const double root = std::sqrt(std::sqrt(sum));
    gradient /= sum * root;
    const double share = std::hypot(gradient.x, gradient.y, gradient.z);
    return share > 0.0 ? RoundedContact{least / root, gradient / share, share} : RoundedContact{};
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
