// SPDX-License-Identifier: Apache-2.0
#include "dsp/geometry/surface_net.hpp"

#include "dsp/core/random.hpp"
#include "dsp/volume/surface_distance.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <map>
#include <utility>

using namespace tactus;

namespace {

// Ones strewn over the inner samples of a grid, of the given share: every way in which parts can touch.
volume::Grid speckles(double share, std::uint64_t seed) {
    const Random random{seed};
    volume::Grid grid{{9, 8, 7}, Vec3(-0.3, 0.1, 1.0), Vec3(0.5e-3, 0.5e-3, 0.9e-3), {}};
    grid.values.assign(grid.count(), 0.0f);
    std::uint64_t n = 0;
    for (int k = 1; k + 1 < grid.size[2]; ++k)
        for (int j = 1; j + 1 < grid.size[1]; ++j)
            for (int i = 1; i + 1 < grid.size[0]; ++i) grid.at(i, j, k) = random.uniform(n++) < share ? 1.0f : 0.0f;
    return grid;
}

// Edges that triangles do not pass as often one way as the other.
long open_edges(const geometry::TriangleSurface& surface) {
    std::map<std::pair<std::int32_t, std::int32_t>, int> balance;
    for (const auto& t : surface.triangles)
        for (std::size_t c = 0; c < 3; ++c) {
            const auto a = t[c], b = t[(c + 1) % 3];
            balance[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    return std::count_if(balance.begin(), balance.end(), [](const auto& edge) { return edge.second != 0; });
}

}  // namespace

TEST_CASE("the net of any samples is closed and has those on its inside that are in, however its parts touch") {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const volume::Grid grid = speckles(0.1 + 0.013 * static_cast<double>(seed), seed);
        geometry::SurfaceNet net = geometry::surface_net(grid, 0.5f, true);
        CAPTURE(seed);
        CHECK(open_edges(net) == 0);
        const volume::Grid layout{grid.size, grid.origin, grid.spacing, {}};
        const auto winding = volume::winding_numbers(layout, net);
        CHECK(std::equal(winding.begin(), winding.end(), grid.values.begin(),
                         [](std::int16_t turns, float value) { return static_cast<float>(turns) == value; }));
        // Without the staircase a sample may change sides, but none is wound around twice or backwards.
        geometry::relax(net, grid, 40);
        const auto relaxed = volume::winding_numbers(layout, net);
        CHECK(std::all_of(relaxed.begin(), relaxed.end(), [](std::int16_t turns) { return turns == 0 || turns == 1; }));
    }
}
