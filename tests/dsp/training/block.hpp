// SPDX-License-Identifier: Apache-2.0
// A block of bone and saw cuts of known position in it, as exact distances.
#pragma once

#include "dsp/training/removed.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <functional>

namespace tactus::test {

/// A grid of the values of a function of the position.
inline volume::Grid grid_of(const Vec3& low, const Vec3& high, double h, const std::function<double(const Vec3&)>& f) {
    volume::Grid grid{{}, low, Vec3(h), {}};
    for (std::size_t a = 0; a < 3; ++a) grid.size[a] = static_cast<int>((high - low)[static_cast<int>(a)] / h) + 1;
    grid.values.reserve(grid.count());
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) grid.values.push_back(static_cast<float>(f(grid.position(i, j, k))));
    return grid;
}

/// Signed distance to a box of half edges `half` about the origin.
inline double box_distance(const Vec3& p, const Vec3& half) {
    const Vec3 q = glm::abs(p) - half;
    return glm::length(glm::max(q, Vec3(0.0))) + std::min(0.0, std::max({q.x, q.y, q.z}));
}

/// Half edges of the block, m: cut from above (feed -z), blade along x, the planned plane is y = 0.
inline const Vec3 block_half{10e-3, 12e-3, 8e-3};

inline training::PlannedCut block_plan() {
    training::PlannedCut cut;
    cut.point = {0.0, 0.0, 8e-3};
    cut.feed = {0.0, 0.0, -1.0};
    cut.stroke = {1.0, 0.0, 0.0};
    cut.normal = glm::cross(cut.stroke, cut.feed);
    cut.depth = 16e-3;
    return cut;
}

inline volume::Grid whole_block(double h) {
    return grid_of(-block_half - Vec3(2e-3), block_half + Vec3(2e-3), h,
                   [](const Vec3& p) { return box_distance(p, block_half); });
}

/// The block after a cut: a slab `kerf` wide about the plane through `point` with the unit `normal`, down to `depth`
/// below the top.
inline volume::Grid cut_block(double h, const Vec3& point, const Vec3& normal, double kerf, double depth) {
    return grid_of(-block_half - Vec3(2e-3), block_half + Vec3(2e-3), h, [&](const Vec3& p) {
        const double slab = std::max(std::abs(glm::dot(p - point, normal)) - 0.5 * kerf, block_half.z - depth - p.z);
        return std::max(box_distance(p, block_half), -slab);
    });
}

}  // namespace tactus::test
