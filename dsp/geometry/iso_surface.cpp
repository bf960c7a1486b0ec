// SPDX-License-Identifier: Apache-2.0
#include "dsp/geometry/iso_surface.hpp"

#include "dsp/core/stop.hpp"
#include "dsp/geometry/tetrahedra.hpp"

#include <algorithm>

namespace tactus::geometry {

namespace {

struct Marcher {
    const volume::Grid& grid;
    float iso;
    bool inside_above;
    TriangleSurface& out;
    std::array<std::vector<int>, 2> edges;  // vertex per (sample, edge direction) of this layer and the next, or -1

    bool is_inside(float value) const { return (value >= iso) == inside_above; }

    int vertex(int i, int j, int k, int from, int to) {
        const int a = i + (from & 1), b = j + (from >> 1 & 1), c = from >> 2;
        const int step = to ^ from;
        const std::size_t sample =
            static_cast<std::size_t>(b) * static_cast<std::size_t>(grid.size[0]) + static_cast<std::size_t>(a);
        int& slot = edges[static_cast<std::size_t>((k + c) & 1)][sample * 7 + static_cast<std::size_t>(step - 1)];
        if (slot < 0) {
            const int x = a + (step & 1), y = b + (step >> 1 & 1), z = k + c + (step >> 2);
            const double t = crossing(grid.at(a, b, k + c), grid.at(x, y, z), iso);
            slot = static_cast<int>(out.vertices.size());
            out.vertices.push_back(glm::mix(grid.position(a, b, k + c), grid.position(x, y, z), t));
        }
        return slot;
    }

    void run() {
        const std::size_t layer = 7 * static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1]);
        edges = {std::vector<int>(layer, -1), std::vector<int>(layer, -1)};
        for (int k = 0; k + 1 < grid.size[2]; ++k) {
            leave_if_stopped();
            auto& next = edges[static_cast<std::size_t>((k + 1) & 1)];
            std::fill(next.begin(), next.end(), -1);
            for (int j = 0; j + 1 < grid.size[1]; ++j)
                for (int i = 0; i + 1 < grid.size[0]; ++i) {
                    unsigned bits = 0;
                    for (int c = 0; c < 8; ++c)
                        bits |= static_cast<unsigned>(is_inside(grid.at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))))
                                << c;
                    if (bits == 0 || bits == 0xff) continue;
                    march_cell(
                        bits, [&](int from, int to) { return vertex(i, j, k, from, to); },
                        [&](int a, int b, int c) { out.triangles.push_back({a, b, c}); });
                }
        }
    }
};

}  // namespace

TriangleSurface iso_surface(const volume::Grid& grid, float iso, bool inside_above) {
    TriangleSurface surface;
    if (grid.size[0] > 1 && grid.size[1] > 1 && grid.size[2] > 1) Marcher{grid, iso, inside_above, surface, {}}.run();
    return surface;
}

}  // namespace tactus::geometry
