// SPDX-License-Identifier: Apache-2.0
// Marching tetrahedra for one cell of a grid, six tetrahedra per cell.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace tactus::geometry {

// Corners are numbered by bits: 1 = +x, 2 = +y, 4 = +z. Every tetrahedron goes from 0 to 7 and adds one bit at a time,
// so an edge always leads from a corner to one whose bits include it, and neighbouring cells share face diagonals.
// Corners are ordered so that every tetrahedron is right-handed.
inline constexpr std::array<std::array<int, 4>, 6> cell_tetrahedra{
    {{0, 1, 3, 7}, {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 6, 4, 7}}};

/// Position of the crossing between two samples, 0 to 1. It is kept away from the samples, because a vertex common to
/// many edges would create degenerate triangles.
inline double crossing(double low, double high, double iso) {
    return std::clamp((iso - low) / (high - low), 1e-3, 1.0 - 1e-3);
}

/// The triangles of one cell. Bit c of `inside` is set if corner c is inside; `vertex(from, to)` gives the vertex on
/// the edge between two corners, `from` < `to`; `add(a, b, c)` receives a triangle, counter-clockwise seen from
/// outside.
template <class Vertex, class Add>
void march_cell(unsigned inside, const Vertex& vertex_on, const Add& add_triangle) {
    const auto vertex = [&](int from, int to) { return from < to ? vertex_on(from, to) : vertex_on(to, from); };
    const auto add = [&](int a, int b, int c, bool even) {
        if (!even) std::swap(b, c);
        add_triangle(a, b, c);
    };
    // Even permutations keep the handedness of (apex, rest), which decides the winding.
    const auto is_even = [](std::array<int, 4> p) {
        int swaps = 0;
        for (std::size_t a = 0; a < 4; ++a)
            for (std::size_t b = a + 1; b < 4; ++b) swaps += p[a] > p[b];
        return swaps % 2 == 0;
    };
    for (const auto& corners : cell_tetrahedra) {
        std::array<int, 4> in{}, outside{}, in_place{}, out_place{};
        int n = 0, m = 0;
        for (int c = 0; c < 4; ++c) {
            const int corner = corners[static_cast<std::size_t>(c)];
            if (inside >> corner & 1u) {
                in_place[static_cast<std::size_t>(n)] = c;
                in[static_cast<std::size_t>(n++)] = corner;
            } else {
                out_place[static_cast<std::size_t>(m)] = c;
                outside[static_cast<std::size_t>(m++)] = corner;
            }
        }
        if (n == 0 || m == 0) continue;
        if (n == 1 || m == 1) {
            const bool apex_in = n == 1;
            const auto& apex = apex_in ? in : outside;
            const auto& rest = apex_in ? outside : in;
            const int place = apex_in ? in_place[0] : out_place[0];
            const auto& rest_place = apex_in ? out_place : in_place;
            const bool even = is_even({place, rest_place[0], rest_place[1], rest_place[2]});
            add(vertex(apex[0], rest[0]), vertex(apex[0], rest[1]), vertex(apex[0], rest[2]), even == apex_in);
            continue;
        }
        const bool even = is_even({in_place[0], in_place[1], out_place[0], out_place[1]});
        const int p = vertex(in[0], outside[0]), q = vertex(in[0], outside[1]);
        const int r = vertex(in[1], outside[1]), s = vertex(in[1], outside[0]);
        add(p, q, r, even);
        add(p, r, s, even);
    }
}

}  // namespace tactus::geometry
