// SPDX-License-Identifier: Apache-2.0
// The sheets of a surface within one cell of a grid, for dual methods.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace tactus::geometry {

/// The edges of a cell that cross the surface, by the in/out state of its eight samples; an edge is named by its low
/// corner and axis. Crossing edges are linked around the faces of the cell; each closed ring is one sheet with its own
/// vertex. A face with inside samples at opposite corners is cut around each inside corner: both cells that share the
/// face get the same cuts, so that neighbouring sheets meet without a hole.
struct CellSheets {
    std::array<int, 24> of_edge{};  ///< index of the sheet for 3 · low corner + axis; -1: no crossing
    int count = 0;

    CellSheets() = default;
    explicit CellSheets(unsigned in) {
        const auto is_in = [in](int corner) { return (in >> corner & 1u) != 0; };
        for (int edge = 0; edge < 24; ++edge) {
            const int low = edge / 3, high = low | 1 << edge % 3;
            of_edge[at(edge)] = high != low && is_in(low) != is_in(high) ? edge : -1;
        }
        for (int axis = 0; axis < 3; ++axis)
            for (const int face : {0, 1 << axis}) {
                const int b = 1 << (axis + 1) % 3, c = 1 << (axis + 2) % 3;
                const std::array<int, 4> corner{face, face | b, face | b | c, face | c};
                std::array<int, 4> edge{};  // from each corner to the next
                int crossings = 0;
                for (int n = 0; n < 4; ++n) {
                    edge[at(n)] = between(corner[at(n)], corner[at((n + 1) % 4)]);
                    crossings += of_edge[at(edge[at(n)])] >= 0;
                }
                for (int n = 0; n < 4; ++n) {
                    const int before = edge[at((n + 3) % 4)];
                    if (crossings == 4 && is_in(corner[at(n)])) join(before, edge[at(n)]);
                    for (int m = 0; crossings == 2 && m < n; ++m) join(edge[at(m)], edge[at(n)]);
                }
            }
        std::array<int, 24> number;
        number.fill(-1);
        for (int& sheet : of_edge) {
            if (sheet < 0) continue;
            int& known = number[at(sheet)];
            if (known < 0) known = count++;
            sheet = known;
        }
    }

    /// For each of the 256 in/out states.
    static std::vector<CellSheets> of_all_states() {
        std::vector<CellSheets> all;
        for (unsigned in = 0; in < 256; ++in) all.emplace_back(in);
        return all;
    }

    static std::size_t at(int n) { return static_cast<std::size_t>(n); }
    static int between(int a, int b) {
        const int along = a ^ b;
        return 3 * std::min(a, b) + (along == 4 ? 2 : along - 1);
    }

    // Until the end a sheet is identified by one of its edges.
    void join(int a, int b) {
        const int kept = of_edge[at(a)], dropped = of_edge[at(b)];
        if (kept < 0 || dropped < 0) return;
        std::replace(of_edge.begin(), of_edge.end(), dropped, kept);
    }
};

}  // namespace tactus::geometry
