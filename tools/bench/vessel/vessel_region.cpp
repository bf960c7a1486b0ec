// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/vessel/vessel_region.hpp"
#include "devices/display/png.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::bench {

namespace {

using Index = std::array<int, 3>;

Index nearest(const volume::Grid& grid, const Vec3& place) {
    const Vec3 at = (place - grid.origin) / grid.spacing;
    return {static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y)),
            static_cast<int>(std::lround(at.z))};
}

bool is_inside(const volume::Grid& grid, const Index& at) {
    for (std::size_t a = 0; a < 3; ++a)
        if (at[a] < 0 || at[a] >= grid.size[a]) return false;
    return true;
}

template <class F>
void each(const volume::Grid& grid, F&& f) {
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) f(Index{i, j, k}, grid.index(i, j, k));
}

}  // namespace

Mask grown_region(const volume::Grid& grid, const Vec3& seed, double low, double high, std::size_t axis) {
    Mask region(grid.count(), 0);
    const Index start = nearest(grid, seed);
    if (!is_inside(grid, start)) return region;
    // The part of a slice that is joined with one of `from`.
    const auto part_of_slice = [&](const std::vector<Index>& from, std::size_t most) {
        Mask seen(grid.count(), 0);
        std::vector<Index> open = from, part;
        while (!open.empty() && part.size() <= most) {
            const Index at = open.back();
            open.pop_back();
            if (!is_inside(grid, at)) continue;
            const std::size_t n = grid.index(at[0], at[1], at[2]);
            if (seen[n] || !(double(grid.values[n]) >= low && double(grid.values[n]) <= high)) continue;
            seen[n] = 1;
            part.push_back(at);
            for (std::size_t a = 0; a < 3; ++a)
                for (const int side : {-1, 1}) {
                    if (a == axis) continue;
                    Index next = at;
                    next[a] += side;
                    open.push_back(next);
                }
        }
        return part;
    };
    const std::vector<Index> first = part_of_slice({start}, grid.count());
    for (const int way : {-1, 1}) {
        std::vector<Index> part = first;
        std::vector<std::size_t> areas;
        while (!part.empty()) {
            areas.push_back(part.size());
            for (const Index& at : part) region[grid.index(at[0], at[1], at[2])] = 1;
            std::vector<std::size_t> sorted = areas;
            std::ranges::sort(sorted);
            const std::size_t most = 2 * sorted[sorted.size() / 2];
            for (Index& at : part) at[axis] += way;
            part = part_of_slice(part, most);
            if (part.size() > most) break;  // it has run into something larger
        }
    }
    return region;
}

Mask grown(const volume::Grid& grid, const Mask& mask) {
    Mask out(mask.size(), 0);
    each(grid, [&](const Index& at, std::size_t n) {
        if (!mask[n]) return;
        for (int m = 0; m < 27; ++m) {
            const Index there{at[0] + m % 3 - 1, at[1] + m / 3 % 3 - 1, at[2] + m / 9 - 1};
            if (is_inside(grid, there)) out[grid.index(there[0], there[1], there[2])] = 1;
        }
    });
    return out;
}

bool holds(const volume::Grid& grid, const Mask& mask, const Vec3& place) {
    const Index at = nearest(grid, place);
    return is_inside(grid, at) && mask[grid.index(at[0], at[1], at[2])];
}

void draw_region(const volume::Grid& grid, const Mask& region, const std::vector<Vec3>& places,
                 const std::filesystem::path& path) {
    Index low = grid.size, high{-1, -1, -1};
    const auto include = [&](const Index& at) {
        for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], at[a]), high[a] = std::max(high[a], at[a]);
    };
    each(grid, [&](const Index& at, std::size_t n) {
        if (region[n]) include(at);
    });
    for (const Vec3& place : places)
        if (is_inside(grid, nearest(grid, place))) include(nearest(grid, place));
    for (std::size_t a = 0; a < 3; ++a)
        low[a] = std::max(0, low[a] - 12), high[a] = std::min(grid.size[a] - 1, high[a] + 12);
    constexpr int zoom = 5;
    constexpr std::size_t axes[3][2] = {{0, 2}, {1, 2}, {0, 1}};  // front, side, top
    display::Image image;
    for (const auto& [u, v] : axes) {
        image.width += (high[u] - low[u] + 1) * zoom + 8;
        image.height = std::max(image.height, (high[v] - low[v] + 1) * zoom);
    }
    image.rgb.assign(3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height), 30);
    int left = 0;
    for (const auto& [u, v] : axes) {
        const std::size_t w = 3 - u - v;
        const bool flips = v == 2;  // the head is up
        const auto set = [&, ux = u, vx = v](int x, int y, std::array<int, 3> colour) {
            if (x < 0 || x >= (high[ux] - low[ux] + 1) * zoom || y < 0 || y >= (high[vx] - low[vx] + 1) * zoom) return;
            for (std::size_t c = 0; c < 3; ++c)
                image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                               static_cast<std::size_t>(left + x)) +
                          c] = static_cast<std::uint8_t>(std::clamp(colour[c], 0, 255));
        };
        for (int b = low[v]; b <= high[v]; ++b)
            for (int a = low[u]; a <= high[u]; ++a) {
                float most = -1e9f;
                bool in_region = false;
                Index at{};
                at[u] = a, at[v] = b;
                for (at[w] = low[w]; at[w] <= high[w]; ++at[w]) {
                    const std::size_t n = grid.index(at[0], at[1], at[2]);
                    most = std::max(most, grid.values[n]);
                    in_region = in_region || region[n];
                }
                const int grey = static_cast<int>(std::clamp((double(most) + 150.0) / 850.0, 0.0, 1.0) * 255.0);
                const int y = flips ? high[v] - b : b - low[v];
                for (int s = 0; s < zoom * zoom; ++s)
                    set((a - low[u]) * zoom + s % zoom, y * zoom + s / zoom,
                        in_region ? std::array<int, 3>{grey / 2, grey / 2 + 90, grey / 2}
                                  : std::array<int, 3>{grey, grey, grey});
            }
        for (const Vec3& place : places) {
            const Vec3 at = (place - grid.origin) / grid.spacing + 0.5;
            const int x = static_cast<int>((at[static_cast<int>(u)] - low[u]) * zoom);
            const double from = flips ? high[v] + 1 - at[static_cast<int>(v)] : at[static_cast<int>(v)] - low[v];
            const int y = static_cast<int>(from * zoom);
            for (int s = 0; s < 9; ++s) set(x + s % 3 - 1, y + s / 3 - 1, {255, 40, 30});
        }
        left += (high[u] - low[u] + 1) * zoom + 8;
    }
    display::write_png(image, path.string());
}

}  // namespace tactus::bench
