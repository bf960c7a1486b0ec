// SPDX-License-Identifier: Apache-2.0
#include "dsp/segmentation/watershed.hpp"

#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;
using segmentation::VoxelGraph;

namespace {

/// All voxels of a box; conductances are powers of two.
VoxelGraph box_graph(const std::array<int, 3>& size, std::uint64_t seed, int powers) {
    volume::Grid grid{size, Vec3(0.0), Vec3(1e-3), {}};
    grid.values.assign(grid.count(), 1.0f);
    const std::vector<std::uint8_t> inside(grid.count(), 1);
    VoxelGraph graph = segmentation::make_voxel_graph(grid, inside, {});
    const Random random{seed};
    for (std::size_t n = 0; n < graph.nodes(); ++n)
        for (std::size_t axis = 0; axis < 3; ++axis)
            graph.weight[n][axis] =
                std::ldexp(1.0f, -static_cast<int>(random.bits(3 * n + axis) % static_cast<std::uint64_t>(powers)));
    return graph;
}

/// The strongest weakest conductance of any path from a seed of `label` to each node: relaxed until nothing changes.
std::vector<float> strength(const VoxelGraph& graph, const std::vector<std::uint8_t>& seed, int label) {
    std::vector<float> best(graph.nodes(), 0.0f);
    for (std::size_t n = 0; n < best.size(); ++n)
        if (seed[n] == label) best[n] = 1e9f;
    const auto blocked = [&](std::size_t n) { return seed[n] != 0 && seed[n] != label; };
    for (bool changes = true; changes;) {
        changes = false;
        for (std::size_t n = 0; n < best.size(); ++n)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (graph.next[n][axis] < 0) continue;
                const auto m = static_cast<std::size_t>(graph.next[n][axis]);
                const float w = graph.weight[n][axis];
                const auto relax = [&](std::size_t from, std::size_t to) {
                    if (blocked(to) || std::min(best[from], w) <= best[to]) return;
                    best[to] = std::min(best[from], w);
                    changes = true;
                };
                relax(n, m);
                relax(m, n);
            }
    }
    return best;
}

}  // namespace

TEST_CASE("a watershed gives each voxel to a seed that reaches it over the strongest path") {
    for (std::uint64_t round = 0; round < 20; ++round) {
        const VoxelGraph graph = box_graph({7, 6, 5}, round, 9);
        std::vector<std::uint8_t> seed(graph.nodes(), 0);
        const Random random{100 + round};
        for (std::uint64_t k = 0; k < 6; ++k) seed[random.bits(k) % seed.size()] = static_cast<std::uint8_t>(1 + k % 3);
        const std::vector<std::uint8_t> label = segmentation::watershed(graph, seed);
        std::vector<std::vector<float>> of_label;
        for (int l = 1; l <= 3; ++l) of_label.push_back(strength(graph, seed, l));
        for (std::size_t n = 0; n < label.size(); ++n) {
            REQUIRE(label[n] != 0);
            if (seed[n] != 0) CHECK(label[n] == seed[n]);
            const float most = std::max({of_label[0][n], of_label[1][n], of_label[2][n]});
            if (of_label[label[n] - 1u][n] != most) FAIL("round " << round << ", voxel " << n);
        }
    }
}

TEST_CASE("a watershed divides a plateau by distance, and leaves parts without a seed") {
    VoxelGraph graph = box_graph({21, 5, 5}, 1, 1);
    // Cut off the last three layers.
    for (std::size_t n = 0; n < graph.nodes(); ++n)
        if (graph.place(n)[0] == 17) graph.next[n][0] = -1;
    std::vector<std::uint8_t> seed(graph.nodes(), 0);
    seed[0] = 1;
    for (std::size_t n = 0; n < graph.nodes(); ++n)
        if (graph.place(n) == std::array<int, 3>{17, 0, 0}) seed[n] = 2;
    const std::vector<std::uint8_t> label = segmentation::watershed(graph, seed);
    for (std::size_t n = 0; n < label.size(); ++n) {
        const int x = graph.place(n)[0];
        CHECK(label[n] == (x > 17 ? 0 : x < 9 ? 1 : 2));
    }
}
