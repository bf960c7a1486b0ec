// SPDX-License-Identifier: Apache-2.0
#include "dsp/segmentation/label_map.hpp"

#include "dsp/segmentation/propose_seeds.hpp"
#include "dsp/segmentation/strokes.hpp"
#include "dsp/segmentation/uncertain.hpp"
#include "tests/dsp/segmentation/phantom.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace tactus;
using namespace tactus::test;

TEST_CASE("dsp: a stroke covers the voxels within its radius of its line") {
    const Phantom p = noisy_cube(20);
    const segmentation::VoxelGraph graph = p.graph();
    const auto node = graph.node_of_voxel();
    std::vector<std::uint8_t> seed(graph.nodes(), 0);
    const segmentation::Stroke stroke{2.5e-3, {Vec3(4, 5, 6) * 1e-3, Vec3(14, 9, 6) * 1e-3}};
    const std::size_t covered = segmentation::paint(p.grid, node, stroke, 3, seed);
    std::size_t expected = 0;
    for (std::size_t n = 0; n < graph.nodes(); ++n) {
        const auto at = graph.place(n);
        const Vec3 q = Vec3(at[0], at[1], at[2]) * 1e-3;
        double nearest = std::numeric_limits<double>::infinity();
        for (int s = 0; s <= 10000; ++s)
            nearest = std::min(nearest, glm::length(q - glm::mix(stroke.points[0], stroke.points[1], s * 1e-4)));
        if (std::abs(nearest - stroke.radius) < 1e-9) continue;
        CHECK((seed[n] == 3) == (nearest < stroke.radius));
        expected += nearest < stroke.radius;
    }
    CHECK(covered == expected);
    // A thin stroke paints the voxel that contains it; one far away paints nothing.
    CHECK(segmentation::paint(p.grid, node, {1e-6, {Vec3(3.4, 3.3, 3.4) * 1e-3}}, 1, seed) == 1);
    CHECK(segmentation::paint(p.grid, node, {3e-3, {Vec3(1e5, 0.0, 0.0)}}, 1, seed) == 0);
    CHECK(segmentation::paint(p.grid, node, {3e-3, {}}, 1, seed) == 0);
}

TEST_CASE("dsp: open voxels take the label with the fewest steps to it") {
    segmentation::LabelMap map{{9, 1, 1}, {0, 1, 0, 0, 0, 0, 2, 0, 0}};
    const std::vector<std::uint8_t> open{1, 1, 1, 1, 1, 1, 1, 1, 0};
    CHECK(segmentation::spread(map, open) == 6);
    CHECK(map.label == std::vector<std::uint8_t>{1, 1, 1, 1, 2, 2, 2, 2, 0});
}

TEST_CASE("dsp: marrow behind an open cortex is taken in and a gap between two bones is not") {
    // Two tubes along z with walls of two voxels, 3 voxels apart; one has a hole in its wall.
    segmentation::LabelMap map{{44, 22, 20}, {}};
    const Vec3 h(1e-3);
    std::vector<std::uint8_t> gap;
    for (int k = 0; k < 20; ++k)
        for (int j = 0; j < 22; ++j)
            for (int i = 0; i < 44; ++i) {
                const double a = std::hypot(i - 10.5, j - 10.5), b = std::hypot(i - 32.5, j - 10.5);
                const bool hole = k == 10 && j == 10 && i < 10;
                const bool closed = k < 2 || k > 17;
                map.label.push_back(a < 9.5 && (a > 7.5 || closed) && !hole ? 1
                                    : b < 9.5 && (b > 7.5 || closed)        ? 2
                                                                            : 0);
                gap.push_back(i >= 20 && i <= 22 && j > 8 && j < 13);
            }
    const auto marrow = segmentation::marrow_of(map, h, 2e-3);
    const auto at = [&](int i, int j, int k) { return static_cast<std::size_t>((k * 22 + j) * 44 + i); };
    CHECK(marrow[at(10, 10, 10)] == 1);
    CHECK(marrow[at(32, 10, 10)] == 1);
    std::size_t in_gap = 0;
    for (std::size_t v = 0; v < gap.size(); ++v) in_gap += gap[v] != 0 && marrow[v] != 0;
    CHECK(in_gap == 0);
    // Nothing is labelled twice.
    for (std::size_t v = 0; v < gap.size(); ++v)
        if (map.label[v] != 0) CHECK(marrow[v] == 0);
}

TEST_CASE("dsp: the area where labels touch is that of their common faces") {
    segmentation::LabelMap map{{4, 3, 2}, std::vector<std::uint8_t>(24, 0)};
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 4; ++i) map.label[static_cast<std::size_t>((k * 3 + j) * 4 + i)] = i < 2 ? 5 : 2;
    const auto touching = segmentation::touching_labels(map, Vec3(1.0, 2.0, 3.0));
    REQUIRE(touching.size() == 1);
    CHECK(touching[0].a == 2);
    CHECK(touching[0].b == 5);
    CHECK(touching[0].faces == 6);
    CHECK(touching[0].area == Approx(36.0));
}

TEST_CASE("dsp: the largest uncertain region comes first with its deepest voxel") {
    const Phantom p = noisy_cube(20);
    const segmentation::VoxelGraph graph = p.graph();
    std::vector<float> certain(graph.nodes(), 0.9f);
    for (std::size_t n = 0; n < graph.nodes(); ++n) {
        const auto at = graph.place(n);
        const Vec3 q(at[0], at[1], at[2]);
        if (glm::length(q - Vec3(6, 7, 8)) < 4.5) certain[n] = 0.1f;
        if (glm::length(q - Vec3(15, 15, 15)) < 2.5) certain[n] = 0.3f;
    }
    const auto regions = segmentation::uncertain_regions(graph, certain, 0.4);
    REQUIRE(regions.size() == 2);
    CHECK(regions[0].nodes > regions[1].nodes);
    CHECK(regions[0].deepest == std::array<int, 3>{6, 7, 8});
    CHECK(regions[1].deepest == std::array<int, 3>{15, 15, 15});
    CHECK(segmentation::uncertain_regions(graph, certain, 0.05).empty());
}

TEST_CASE("dsp: seeds are proposed for each of two blocks that touch over a small disc") {
    const Phantom p = bridged_blocks(4.0, 9);
    const segmentation::VoxelGraph graph = p.graph();
    const auto law = segmentation::gap_law(segmentation::gap_statistics(p.grid, p.inside));
    const auto fragments = segmentation::propose_seeds(graph, p.grid, law);
    REQUIRE(fragments.size() == 2);
    for (const auto& fragment : fragments) {
        REQUIRE(!fragment.strokes.empty());
        const bool left = fragment.strokes[0].points[0].x < 20e-3;
        for (const auto& stroke : fragment.strokes) CHECK((stroke.points[0].x < 20e-3) == left);
    }
    // One block is one fragment.
    CHECK(segmentation::propose_seeds(noisy_cube(20).graph(), noisy_cube(20).grid, {0.0, 1.0, 1e-4}).size() <= 1);
}

TEST_CASE("dsp: the statistics of a scan scale with it and measure its noise") {
    Phantom p = noisy_cube(32);
    for (std::size_t v = 0; v < p.grid.values.size(); ++v)
        p.grid.values[v] = static_cast<float>(1000.0 + 25.0 * Random{4}.normal(v));
    const auto found = segmentation::gap_statistics(p.grid, p.inside);
    CHECK(found.noise == Approx(25.0).epsilon(0.03));
    CHECK(found.bright == Approx(1000.0 + 25.0 * 0.2533).margin(1.0));
    CHECK(found.dark == Approx(1000.0 - 25.0 * 1.645).margin(1.5));
    for (float& value : p.grid.values) value = 0.01f * value - 3.0f;
    const auto scaled = segmentation::gap_statistics(p.grid, p.inside);
    CHECK(scaled.noise == Approx(0.01 * found.noise).epsilon(1e-3));
    CHECK(scaled.bright == Approx(0.01 * found.bright - 3.0).epsilon(1e-4));
    // Whole numbers: what rounding moves is far below one.
    for (std::size_t v = 0; v < p.grid.values.size(); ++v)
        p.grid.values[v] = static_cast<float>(std::round(100.0 + 2.5 * Random{4}.normal(v)));
    const auto rounded = segmentation::gap_statistics(p.grid, p.inside);
    CHECK(rounded.bright == Approx(100.0 + 2.5 * 0.2533).margin(0.1));
    CHECK(rounded.noise == Approx(2.5).epsilon(0.03));
    // Sums of scaled whole numbers differ in their last bits where they were equal.
    for (float& value : p.grid.values) value *= 1e-3f;
    const auto thousandth = segmentation::gap_statistics(p.grid, p.inside);
    CHECK(thousandth.noise == Approx(1e-3 * rounded.noise).epsilon(1e-5));
    CHECK(thousandth.bright == Approx(1e-3 * rounded.bright).epsilon(1e-5));
    // Coarse steps, as in 8 bits: noise as wide as a step.
    for (std::size_t v = 0; v < p.grid.values.size(); ++v)
        p.grid.values[v] = static_cast<float>(std::round(100.0 + Random{4}.normal(v)));
    CHECK(segmentation::gap_statistics(p.grid, p.inside).noise == Approx(1.0).epsilon(0.03));
    // A uniform volume has no noise and no range, and still a law.
    std::fill(p.grid.values.begin(), p.grid.values.end(), 7.0f);
    CHECK(segmentation::gap_law(segmentation::gap_statistics(p.grid, p.inside)).width > 0.0);
}
