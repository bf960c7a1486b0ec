// SPDX-License-Identifier: Apache-2.0
#include "dsp/distance/components.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tactus {

namespace {

// Visits every sample joined to `seed` for which `enter(n)` says yes; enter must mark what it accepts.
template <typename Enter>
std::size_t flood(const Grid& grid, std::size_t seed, bool faces_only, std::vector<std::size_t>& stack, Enter enter) {
    const auto width = static_cast<std::size_t>(grid.size[0]), rows = static_cast<std::size_t>(grid.size[1]);
    std::size_t count = 0;
    if (enter(seed)) stack.push_back(seed);
    while (!stack.empty()) {
        const std::size_t n = stack.back();
        stack.pop_back();
        ++count;
        const int i = static_cast<int>(n % width), j = static_cast<int>(n / width % rows);
        const int k = static_cast<int>(n / width / rows);
        for (int dz = -1; dz <= 1; ++dz)
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    if (faces_only && std::abs(dx) + std::abs(dy) + std::abs(dz) != 1) continue;
                    const int x = i + dx, y = j + dy, z = k + dz;
                    if (x < 0 || y < 0 || z < 0 || x >= grid.size[0] || y >= grid.size[1] || z >= grid.size[2])
                        continue;
                    const std::size_t other = grid.index(x, y, z);
                    if (enter(other)) stack.push_back(other);
                }
    }
    return count;
}

float below(float iso) { return std::nextafter(iso, -std::numeric_limits<float>::infinity()); }

}  // namespace

Components components_above(const Grid& grey, float iso) {
    Components found;
    found.label.assign(grey.count(), 0);
    std::vector<std::size_t> stack, sizes;
    for (std::size_t n = 0; n < grey.values.size(); ++n) {
        const auto label = static_cast<std::int32_t>(sizes.size() + 1);
        const std::size_t size = flood(grey, n, false, stack, [&](std::size_t m) {
            if (found.label[m] != 0 || !(grey.values[m] >= iso)) return false;
            found.label[m] = label;
            return true;
        });
        if (size > 0) sizes.push_back(size);
    }
    std::vector<std::size_t> order(sizes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
    std::vector<std::int32_t> rank(sizes.size() + 1, 0);
    for (std::size_t r = 0; r < order.size(); ++r) {
        rank[order[r] + 1] = static_cast<std::int32_t>(r + 1);
        found.voxels.push_back(sizes[order[r]]);
    }
    for (std::int32_t& label : found.label) label = rank[static_cast<std::size_t>(label)];
    return found;
}

void keep_largest(Grid& grey, float iso, const Components& components, std::size_t keep) {
    for (std::size_t n = 0; n < grey.values.size(); ++n)
        if (components.label[n] > 0 && static_cast<std::size_t>(components.label[n]) > keep)
            grey.values[n] = std::min(2.0f * iso - grey.values[n], below(iso));
}

std::size_t fill_hollows(Grid& grey, float iso) {
    std::vector<char> open(grey.count(), 0);
    std::vector<std::size_t> stack;
    const auto enter = [&](std::size_t n) {
        if (open[n] || grey.values[n] >= iso) return false;
        open[n] = 1;
        return true;
    };
    const auto& size = grey.size;
    for (int k = 0; k < size[2]; ++k)
        for (int j = 0; j < size[1]; ++j)
            for (int i = 0; i < size[0]; ++i)
                if (i == 0 || j == 0 || k == 0 || i == size[0] - 1 || j == size[1] - 1 || k == size[2] - 1)
                    flood(grey, grey.index(i, j, k), true, stack, enter);
    std::size_t filled = 0;
    for (std::size_t n = 0; n < open.size(); ++n)
        if (!open[n] && grey.values[n] < iso) {
            grey.values[n] = 2.0f * iso - grey.values[n];
            ++filled;
        }
    return filled;
}

}  // namespace tactus
