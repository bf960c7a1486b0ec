// SPDX-License-Identifier: Apache-2.0
// A bone small enough to be broken in a test.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/types.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::test {

/// A bar of egg-shaped section, 12 by 22 mm and 40 mm long.
inline bone::Bone bar() {
    bone::Bone bone;
    volume::Grid& grid = bone.distance;
    grid = {{95, 37, 59}, Vec3(-23.5, -9.0, -14.5) * mm, Vec3(0.5 * mm), {}};
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                const Vec3 p = grid.position(i, j, k);
                const double width = 6.0 * mm * (1.0 - 0.2 * p.z / (11.0 * mm));
                const double r = std::hypot(p.y / width, p.z / (11.0 * mm));
                grid.values.push_back(static_cast<float>(std::max((r - 1.0) * 7.0 * mm, std::abs(p.x) - 20.0 * mm)));
            }
    bone.density = grid;
    for (float& d : bone.density.values) d = d < 0.0f ? 1500.0f : 0.0f;
    bone.name = "bar";
    return bone;
}

}  // namespace tactus::test
