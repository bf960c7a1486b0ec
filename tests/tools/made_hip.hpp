// SPDX-License-Identifier: Apache-2.0
// The right half of a pelvis by formula, to be broken in tests.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::test {

/// m, negative inside: a curved wing, a body with the socket of the hip, and the ring below it.
inline double outside_of_hip(const Vec3& p) {
    const auto ball = [&](const Vec3& middle, double radius) { return glm::length(p - middle) - radius; };
    // The wing is a plate of 8 mm of a large sphere, within an oval.
    const double plate = std::abs(ball(Vec3(-95.0, 0.0, 70.0) * mm, 105.0 * mm)) - 4.0 * mm;
    const Vec3 in_wing = (p - Vec3(6.0, 0.0, 65.0) * mm) / Vec3(60.0 * mm, 55.0 * mm, 48.0 * mm);
    const double wing = std::max(plate, (glm::length(in_wing) - 1.0) * 48.0 * mm);
    const double body =
        std::max(ball(Vec3(5.0, 0.0, 5.0) * mm, 32.0 * mm), -ball(Vec3(28.0, -6.0, 0.0) * mm, 24.0 * mm));
    const Vec3 in_ring = p - Vec3(-6.0, -14.0, -46.0) * mm;
    const double ring = std::hypot(std::hypot(in_ring.y, in_ring.z) - 27.0 * mm, in_ring.x) - 8.0 * mm;
    return std::min({wing, body, ring});
}

inline bone::Bone made_hip() {
    bone::Bone bone;
    volume::Grid& grid = bone.distance;
    constexpr double voxel = 1.2 * mm;
    const Vec3 low = Vec3(-40.0, -65.0, -92.0) * mm, high = Vec3(60.0, 65.0, 120.0) * mm;
    grid = {{}, low, Vec3(voxel), {}};
    for (int a = 0; a < 3; ++a) grid.size[static_cast<std::size_t>(a)] = static_cast<int>((high - low)[a] / voxel) + 1;
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i)
                grid.values.push_back(
                    static_cast<float>(std::clamp(outside_of_hip(grid.position(i, j, k)), -6.0 * mm, 6.0 * mm)));
    bone.density = grid;
    for (float& d : bone.density.values) d = d < 0.0f ? 1300.0f : 0.0f;
    bone.name = "hip";
    return bone;
}

}  // namespace tactus::test
