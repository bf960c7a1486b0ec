// SPDX-License-Identifier: Apache-2.0
#include "dsp/distance/iso_surface.hpp"

#include <algorithm>
#include <utility>

namespace tactus {

namespace {

// Corners are numbered by bits: 1 = +x, 2 = +y, 4 = +z. Every tetrahedron runs from 0 to 7, adding one bit at a time,
// so an edge always leads from a corner to one whose bits include it, and neighbouring cells share face diagonals.
// The order of corners is turned where needed to make every tetrahedron right-handed.
constexpr std::array<std::array<int, 4>, 6> tetrahedra{
    {{0, 1, 3, 7}, {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 6, 4, 7}}};

struct Marcher {
    const Grid& grid;
    float iso;
    bool inside_above;
    TriangleSurface& out;
    std::array<std::vector<int>, 2> edges;  // vertex per (sample, edge direction) of this layer and the next, or -1

    bool is_inside(float value) const { return (value >= iso) == inside_above; }

    int vertex(int i, int j, int k, int from, int to) {
        if (from > to) std::swap(from, to);
        const int a = i + (from & 1), b = j + (from >> 1 & 1), c = from >> 2;
        const int step = to ^ from;
        const std::size_t sample =
            static_cast<std::size_t>(b) * static_cast<std::size_t>(grid.size[0]) + static_cast<std::size_t>(a);
        int& slot = edges[static_cast<std::size_t>((k + c) & 1)][sample * 7 + static_cast<std::size_t>(step - 1)];
        if (slot < 0) {
            const int x = a + (step & 1), y = b + (step >> 1 & 1), z = k + c + (step >> 2);
            const double low = grid.at(a, b, k + c), high = grid.at(x, y, z);
            // Held off the samples: a vertex shared by many edges would make triangles without area.
            const double t = std::clamp((iso - low) / (high - low), 1e-3, 1.0 - 1e-3);
            slot = static_cast<int>(out.vertices.size());
            out.vertices.push_back(glm::mix(grid.position(a, b, k + c), grid.position(x, y, z), t));
        }
        return slot;
    }

    void tetrahedron(int i, int j, int k, std::array<int, 4> corners, unsigned inside_bits) {
        std::array<int, 4> in{}, outside{};
        int n = 0, m = 0;
        std::array<int, 4> in_place{}, out_place{};
        for (int c = 0; c < 4; ++c) {
            const int corner = corners[static_cast<std::size_t>(c)];
            if (inside_bits >> corner & 1u) {
                in_place[static_cast<std::size_t>(n)] = c;
                in[static_cast<std::size_t>(n++)] = corner;
            } else {
                out_place[static_cast<std::size_t>(m)] = c;
                outside[static_cast<std::size_t>(m++)] = corner;
            }
        }
        if (n == 0 || m == 0) return;
        const auto add = [&](int a, int b, int c, bool even) {
            if (!even) std::swap(b, c);
            out.triangles.push_back({a, b, c});
        };
        // Even permutations keep the handedness of (apex, rest), which decides the winding.
        const auto is_even = [](std::array<int, 4> p) {
            int swaps = 0;
            for (std::size_t a = 0; a < 4; ++a)
                for (std::size_t b = a + 1; b < 4; ++b) swaps += p[a] > p[b];
            return swaps % 2 == 0;
        };
        if (n == 1 || m == 1) {
            const bool apex_in = n == 1;
            const auto& apex = apex_in ? in : outside;
            const auto& rest = apex_in ? outside : in;
            const int place = apex_in ? in_place[0] : out_place[0];
            const auto& rest_place = apex_in ? out_place : in_place;
            const bool even = is_even({place, rest_place[0], rest_place[1], rest_place[2]});
            add(vertex(i, j, k, apex[0], rest[0]), vertex(i, j, k, apex[0], rest[1]), vertex(i, j, k, apex[0], rest[2]),
                even == apex_in);
            return;
        }
        const bool even = is_even({in_place[0], in_place[1], out_place[0], out_place[1]});
        const int p = vertex(i, j, k, in[0], outside[0]), q = vertex(i, j, k, in[0], outside[1]);
        const int r = vertex(i, j, k, in[1], outside[1]), s = vertex(i, j, k, in[1], outside[0]);
        add(p, q, r, even);
        add(p, r, s, even);
    }

    void run() {
        const std::size_t layer = 7 * static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1]);
        edges = {std::vector<int>(layer, -1), std::vector<int>(layer, -1)};
        for (int k = 0; k + 1 < grid.size[2]; ++k) {
            auto& next = edges[static_cast<std::size_t>((k + 1) & 1)];
            std::fill(next.begin(), next.end(), -1);
            for (int j = 0; j + 1 < grid.size[1]; ++j)
                for (int i = 0; i + 1 < grid.size[0]; ++i) {
                    unsigned bits = 0;
                    for (int c = 0; c < 8; ++c)
                        bits |= static_cast<unsigned>(is_inside(grid.at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))))
                                << c;
                    if (bits == 0 || bits == 0xff) continue;
                    for (const auto& corners : tetrahedra) tetrahedron(i, j, k, corners, bits);
                }
        }
    }
};

}  // namespace

TriangleSurface iso_surface(const Grid& grid, float iso, bool inside_above) {
    TriangleSurface surface;
    if (grid.size[0] > 1 && grid.size[1] > 1 && grid.size[2] > 1) Marcher{grid, iso, inside_above, surface, {}}.run();
    return surface;
}

}  // namespace tactus
