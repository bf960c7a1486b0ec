// SPDX-License-Identifier: Apache-2.0
// A box of bone on a dense grid, and strokes of a saw into it.
#pragma once

#include "dsp/carve/carve_with.hpp"
#include "dsp/volume/grid.hpp"

#include <functional>
#include <vector>

namespace tactus::test {

inline double box_distance(const Vec3& p, const Vec3& low, const Vec3& high) {
    const Vec3 q = glm::max(low - p, p - high);
    return glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

inline volume::Grid sampled(const Vec3& low, const Vec3& high, const Vec3& spacing,
                            const std::function<double(const Vec3&)>& of) {
    volume::Grid grid;
    grid.origin = low;
    grid.spacing = spacing;
    for (int axis = 0; axis < 3; ++axis) {
        grid.size[static_cast<std::size_t>(axis)] = static_cast<int>(std::ceil((high - low)[axis] / spacing[axis])) + 1;
    }
    grid.values.resize(grid.count());
    for (int k = 0; k < grid.size[2]; ++k) {
        for (int j = 0; j < grid.size[1]; ++j) {
            for (int i = 0; i < grid.size[0]; ++i) {
                grid.at(i, j, k) = static_cast<float>(of(grid.position(i, j, k)));
            }
        }
    }
    return grid;
}

/// Trilinear value of a grid, clamped to its border.
inline double trilinear(const volume::Grid& grid, const Vec3& at) {
    const Vec3 top(grid.size[0] - 1.001, grid.size[1] - 1.001, grid.size[2] - 1.001);
    const Vec3 p = glm::clamp((at - grid.origin) / grid.spacing, Vec3(0.0), top);
    const int i = static_cast<int>(p.x), j = static_cast<int>(p.y), k = static_cast<int>(p.z);
    const double u = p.x - i, v = p.y - j, w = p.z - k;
    const auto line = [&](int b, int c) {
        return (1 - u) * static_cast<double>(grid.at(i, b, c)) + u * static_cast<double>(grid.at(i + 1, b, c));
    };
    return (1 - w) * ((1 - v) * line(j, k) + v * line(j + 1, k)) +
           w * ((1 - v) * line(j, k + 1) + v * line(j + 1, k + 1));
}

struct DenseField {
    volume::Grid grid;
    std::function<double(const Vec3&)> bone_density = [](const Vec3&) { return 1800.0; };

    double value(const Vec3& p) const noexcept { return trilinear(grid, p); }
    double density(const Vec3& p) const noexcept { return bone_density(p); }
    float get(int i, int j, int k) const noexcept { return grid.at(i, j, k); }
    bool set(int i, int j, int k, float v) noexcept {
        grid.at(i, j, k) = v;
        return true;
    }
    std::array<int, 3> size() const noexcept { return grid.size; }
    Vec3 origin() const noexcept { return grid.origin; }
    Vec3 spacing() const noexcept { return grid.spacing; }
};

}  // namespace tactus::test
