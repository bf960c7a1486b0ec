// SPDX-License-Identifier: Apache-2.0
#include "dsp/segmentation/random_walk.hpp"

#include "dsp/segmentation/laplacian.hpp"
#include "dsp/segmentation/multigrid.hpp"
#include "dsp/segmentation/strokes.hpp"
#include "tests/dsp/segmentation/phantom.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <thread>

using namespace tactus;
using namespace tactus::test;
using segmentation::VoxelGraph;
using segmentation::Walks;

namespace {

// Gaussian elimination with the full matrix: no code of the solver.
std::vector<double> reference(const VoxelGraph& graph, const std::vector<std::uint8_t>& seed, int label) {
    const std::size_t count = graph.nodes();
    std::vector<std::vector<double>> a(count, std::vector<double>(count + 1, 0.0));
    const auto join = [&](std::size_t from, std::size_t to, double w) {
        if (seed[from] != 0) return;
        a[from][from] += w;
        a[from][to] -= w;
    };
    for (std::size_t n = 0; n < count; ++n)
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (graph.next[n][axis] >= 0) {
                const auto m = static_cast<std::size_t>(graph.next[n][axis]);
                join(n, m, static_cast<double>(graph.weight[n][axis]));
                join(m, n, static_cast<double>(graph.weight[n][axis]));
            }
    for (std::size_t n = 0; n < count; ++n)
        if (seed[n] != 0) a[n][n] = 1.0, a[n][count] = seed[n] == label ? 1.0 : 0.0;
    for (std::size_t n = 0; n < count; ++n) {
        std::size_t pivot = n;
        for (std::size_t m = n; m < count; ++m)
            if (std::abs(a[m][n]) > std::abs(a[pivot][n])) pivot = m;
        std::swap(a[n], a[pivot]);
        for (std::size_t m = n + 1; m < count; ++m) {
            const double f = a[m][n] / a[n][n];
            if (f == 0.0) continue;
            for (std::size_t k = n; k <= count; ++k) a[m][k] -= f * a[n][k];
        }
    }
    std::vector<double> x(count);
    for (std::size_t n = count; n-- > 0;) {
        double sum = a[n][count];
        for (std::size_t k = n + 1; k < count; ++k) sum -= a[n][k] * x[k];
        x[n] = sum / a[n][n];
    }
    return x;
}

void check_probabilities(const Walks& walks) {
    const auto labels = static_cast<std::size_t>(walks.labels);
    double worst = 0.0;
    float low = 1.0f, high = 0.0f;
    for (std::size_t n = 0; n < walks.probability.size(); n += labels) {
        double sum = 0.0;
        for (std::size_t l = 0; l < labels; ++l) {
            sum += static_cast<double>(walks.probability[n + l]);
            low = std::min(low, walks.probability[n + l]);
            high = std::max(high, walks.probability[n + l]);
        }
        worst = std::max(worst, std::abs(sum - 1.0));
    }
    CHECK(worst < 1e-6);
    CHECK(low >= 0.0f);
    CHECK(high <= 1.0f);
}

double share_that_differs(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    std::size_t differ = 0;
    for (std::size_t n = 0; n < a.size(); ++n) differ += a[n] != b[n];
    return static_cast<double>(differ) / static_cast<double>(a.size());
}

}  // namespace

TEST_CASE("dsp: random walks are those of a dense solver") {
    Phantom p = noisy_cube(8);
    p.grid.spacing = Vec3(0.7, 0.7, 1.6) * 1e-3;
    for (std::size_t v = 0; v < p.inside.size(); v += 11) p.inside[v] = 0;
    const VoxelGraph graph = p.graph();
    const auto seed = seeds_at(graph, {{{1, 1, 1}, 1}, {{6, 2, 3}, 2}, {{2, 6, 6}, 3}, {{6, 6, 2}, 1}});
    const Walks walks = segmentation::random_walks(graph, seed, 3, {1e-6, 200});
    CHECK(walks.residual < 1e-5);
    check_probabilities(walks);
    for (int label = 1; label <= 3; ++label) {
        const std::vector<double> exact = reference(graph, seed, label);
        double worst = 0.0;
        for (std::size_t n = 0; n < graph.nodes(); ++n)
            worst = std::max(
                worst, std::abs(exact[n] -
                                static_cast<double>(walks.probability[3 * n + static_cast<std::size_t>(label) - 1])));
        CHECK(worst < 1e-5);
    }
}

TEST_CASE("dsp: between two seeds of a rod the probability is a straight line") {
    Phantom p;
    p.grid = {{101, 1, 1}, Vec3(0.0), Vec3(1e-3), std::vector<float>(101, 500.0f)};
    p.inside.assign(101, 1);
    const VoxelGraph graph = p.graph();
    const Walks walks =
        segmentation::random_walks(graph, seeds_at(graph, {{{0, 0, 0}, 1}, {{100, 0, 0}, 2}}), 2, {1e-7, 200});
    for (std::size_t n = 0; n <= 100; ++n)
        CHECK(static_cast<double>(walks.probability[2 * n]) ==
              Approx(1.0 - static_cast<double>(n) / 100.0).margin(2e-5));
    const auto certainty = segmentation::certainty_of(walks);
    CHECK(certainty[25] == Approx(1.0 - 0.25 / 0.75).margin(1e-4));
    CHECK(certainty[0] == 1.0f);
}

TEST_CASE("dsp: a solve takes as many iterations whatever the size") {
    for (const int edge : {12, 24, 48, 72}) {
        const Phantom p = noisy_cube(edge);
        const VoxelGraph graph = p.graph();
        const int last = edge - 2;
        const Walks walks = segmentation::random_walks(
            graph, seeds_at(graph, {{{1, 1, 1}, 1}, {{last, last, last}, 2}}), 2, {1e-4, 200});
        INFO(edge);
        CHECK(walks.iterations <= 20);
        CHECK(walks.residual < 2e-4);
    }
}

TEST_CASE("dsp: random walks do not depend on threads, nor on how many labels are solved together") {
    const Phantom p = noisy_cube(16);
    const VoxelGraph graph = p.graph();
    std::vector<std::pair<std::array<int, 3>, int>> places;
    for (int l = 0; l < 11; ++l) places.push_back({{1 + l % 3 * 6, 1 + l / 3 * 4, (l * 5) % 16}, l + 1});
    const auto seed = seeds_at(graph, places);
    const Walks once = segmentation::random_walks(graph, seed, 11);
    const RunJobs threads = [](int count, const std::function<void(int)>& job) {
        std::vector<std::jthread> all;
        for (int n = count; n-- > 0;) all.emplace_back([&job, n] { job(n); });
    };
    const Walks again = segmentation::random_walks(graph, seed, 11, {}, nullptr, threads);
    CHECK(once.probability == again.probability);
    check_probabilities(once);

    // The same labels in another order.
    auto turned = seed;
    for (auto& s : turned)
        if (s != 0) s = static_cast<std::uint8_t>(12 - s);
    auto labels = segmentation::labels_of(segmentation::random_walks(graph, turned, 11));
    for (auto& l : labels) l = static_cast<std::uint8_t>(12 - l);
    CHECK(share_that_differs(segmentation::labels_of(once), labels) < 1e-3);
}

TEST_CASE("dsp: labels are the same for HU and scaled values and nearly for eight bits") {
    const Phantom p = bridged_blocks(6.0, 3);
    const auto labels_with = [&](const std::function<float(float)>& change) {
        Phantom q = p;
        for (float& value : q.grid.values) value = change(value);
        const VoxelGraph graph = q.graph();
        return segmentation::labels_of(
            segmentation::random_walks(graph, seeds_at(graph, {{{2, 16, 16}, 1}, {{38, 5, 20}, 2}}), 2));
    };
    const auto labels = labels_with([](float v) { return v; });
    CHECK(std::count(labels.begin(), labels.end(), 2) > 10000);
    CHECK(share_that_differs(labels, labels_with([](float v) { return v / 1000.0f; })) <= 1e-5);
    CHECK(share_that_differs(labels, labels_with([](float v) { return 0.37f * v + 12.0f; })) <= 1e-5);
    CHECK(share_that_differs(labels, labels_with([](float v) {
                                 return std::round(std::clamp((v + 200.0f) / 1500.0f, 0.0f, 1.0f) * 255.0f);
                             })) <= 1e-3);
}

TEST_CASE("dsp: blocks that touch over a disc are cut at the disc") {
    for (const double radius : {3.0, 6.0, 12.0}) {
        std::size_t bridge = 0, right = 0;
        for (std::uint64_t trial = 0; trial < 4; ++trial) {
            const Phantom p = bridged_blocks(radius, trial);
            const VoxelGraph graph = p.graph();
            // Not at the same distance from the gap.
            const auto seed = seeds_at(graph, {{{2, 10, 9}, 1}, {{31, 20, 24}, 2}});
            const auto label = segmentation::labels_of(segmentation::random_walks(graph, seed, 2));
            const auto node = graph.node_of_voxel();
            for (int k = 0; k < 32; ++k)
                for (int j = 0; j < 32; ++j) {
                    if (node[p.grid.index(20, j, k)] < 0) continue;
                    ++bridge;
                    // The label changes between the voxels next to the bridge.
                    right += label[static_cast<std::size_t>(node[p.grid.index(18, j, k)])] == 1 &&
                             label[static_cast<std::size_t>(node[p.grid.index(22, j, k)])] == 2;
                }
        }
        INFO(radius);
        CHECK(bridge > 50);
        CHECK(static_cast<double>(right) >= 0.98 * static_cast<double>(bridge));
    }
}

TEST_CASE("dsp: a stroke in spongy bone labels its fragment, though the cortex touches another one") {
    // Two blocks with a shell of cortex and a spongy core, joined by four voxels of cortex.
    Phantom p;
    p.grid = {{61, 30, 30}, Vec3(0.0), Vec3(1e-3), {}};
    std::size_t v = 0;
    for (int k = 0; k < 30; ++k)
        for (int j = 0; j < 30; ++j)
            for (int i = 0; i < 61; ++i, ++v) {
                const int x = i < 30 ? i : 60 - i;
                const bool is_core = std::min({x, 29 - x, j, 29 - j, k, 29 - k}) >= 3;
                const bool is_bridge = i == 30 && (j == 14 || j == 15) && (k == 0 || k == 1);
                const double value = i == 30 ? (is_bridge ? 800.0 : -900.0) : is_core ? 260.0 : 800.0;
                p.grid.values.push_back(static_cast<float>(value + 20.0 * Random{3}.normal(v)));
                p.inside.push_back(p.grid.values.back() >= 150.0f);
                p.truth.push_back(i < 30 ? 1 : i > 30 ? 2 : 0);
            }
    const auto law = segmentation::gap_law(segmentation::gap_statistics(p.grid, p.inside));
    VoxelGraph graph = segmentation::make_voxel_graph(p.grid, p.inside, law);
    std::vector<std::uint8_t> seed(graph.nodes(), 0);
    const auto nodes = graph.node_of_voxel();
    segmentation::paint(p.grid, nodes, {5e-3, {Vec3(15e-3, 15e-3, 15e-3)}}, 1, seed);
    segmentation::paint(p.grid, nodes, {3e-3, {Vec3(60e-3, 15e-3, 15e-3)}}, 2, seed);
    const auto wrong = [&] {
        const auto label = segmentation::labels_of(segmentation::random_walks(graph, seed, 2));
        std::size_t count = 0;
        for (std::size_t n = 0; n < label.size(); ++n)
            count += p.truth[graph.voxel[n]] != 0 && label[n] != p.truth[graph.voxel[n]];
        return count;
    };
    CHECK(wrong() > graph.nodes() / 4);  // shut in
    graph = segmentation::make_voxel_graph(p.grid, p.inside, segmentation::law_of_seeds(law, graph, p.grid, seed));
    CHECK(wrong() < graph.nodes() / 50);
    // Strokes on cortex leave the law as it is.
    std::fill(seed.begin(), seed.end(), std::uint8_t{0});
    segmentation::paint(p.grid, nodes, {2e-3, {Vec3(0.0, 15e-3, 15e-3)}}, 1, seed);
    CHECK(segmentation::law_of_seeds(law, graph, p.grid, seed).bright == law.bright);
}

TEST_CASE("dsp: an island without a seed gets no label") {
    Phantom p;
    p.grid = {{9, 3, 3}, Vec3(0.0), Vec3(1e-3), std::vector<float>(81, 500.0f)};
    for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 9; ++i) p.inside.push_back(i != 6);
    const VoxelGraph graph = p.graph();
    const auto parts = segmentation::parts_of(graph);
    CHECK(parts.nodes == std::vector<std::size_t>{54, 18});
    const Walks walks = segmentation::random_walks(graph, seeds_at(graph, {{{0, 1, 1}, 1}, {{5, 1, 1}, 2}}), 2);
    const auto label = segmentation::labels_of(walks);
    const auto certainty = segmentation::certainty_of(walks);
    for (std::size_t n = 0; n < graph.nodes(); ++n) {
        CHECK((label[n] == 0) == (graph.place(n)[0] > 6));
        if (label[n] == 0) CHECK(certainty[n] == 0.0f);
    }
}

TEST_CASE("dsp: a solve from an earlier one gives the labels of a new one and no voxel behind other seeds changes") {
    const Phantom p = noisy_cube(24);
    const VoxelGraph graph = p.graph();
    // A wall of label 2 at x = 12.
    std::vector<std::pair<std::array<int, 3>, int>> places{{{2, 2, 2}, 1}, {{20, 20, 20}, 3}};
    for (int k = 0; k < 24; ++k)
        for (int j = 0; j < 24; ++j) places.push_back({{12, j, k}, 2});
    const auto seed = seeds_at(graph, places);
    const Walks before = segmentation::random_walks(graph, seed, 3);
    auto edited = seed;
    for (std::size_t n = 0; n < graph.nodes(); ++n)
        if (graph.place(n)[0] < 6 && graph.place(n)[1] > 18 && graph.place(n)[2] > 20) edited[n] = 3;
    const Walks cold = segmentation::random_walks(graph, edited, 3);
    const Walks warm = segmentation::random_walks(graph, edited, 3, {}, &before);
    CHECK(warm.iterations <= cold.iterations);
    CHECK(warm.residual < 2e-4);
    CHECK(share_that_differs(segmentation::labels_of(warm), segmentation::labels_of(cold)) < 1e-3);
    CHECK(share_that_differs(segmentation::labels_of(warm), segmentation::labels_of(before)) > 1e-2);
    const auto old_label = segmentation::labels_of(before), new_label = segmentation::labels_of(warm);
    for (std::size_t n = 0; n < graph.nodes(); ++n)
        if (graph.place(n)[0] > 12) CHECK(new_label[n] == old_label[n]);
}

TEST_CASE("dsp: the multigrid cycle is linear and symmetric and positive") {
    const Phantom p = noisy_cube(14, 5);
    const VoxelGraph graph = p.graph();
    std::vector<segmentation::NodeState> state(graph.nodes(), segmentation::NodeState::free);
    state[100] = segmentation::NodeState::fixed;
    const segmentation::FreeNodes free = segmentation::free_nodes(graph, state);
    std::vector<std::array<std::int32_t, 3>> place;
    for (const std::uint32_t n : free.node) {
        const auto at = graph.place(n);
        place.push_back({at[0], at[1], at[2]});
    }
    const segmentation::Multigrid multigrid(free.matrix, place);
    CHECK(multigrid.levels() >= 2);
    auto work = multigrid.workspace(1);
    const auto applied = [&](const std::vector<float>& r) {
        std::vector<float> z(r.size());
        multigrid.apply(1, r.data(), z.data(), work);
        return z;
    };
    const auto dot = [](const std::vector<float>& a, const std::vector<float>& b) {
        return std::inner_product(a.begin(), a.end(), b.begin(), 0.0, std::plus<>{},
                                  [](float x, float y) { return static_cast<double>(x) * static_cast<double>(y); });
    };
    std::vector<float> u, v;
    for (std::size_t n = 0; n < free.node.size(); ++n) {
        u.push_back(static_cast<float>(Random{7}.normal(n)));
        v.push_back(static_cast<float>(Random{8}.normal(n)));
    }
    const auto mu = applied(u), mv = applied(v);
    const double scale = std::sqrt(dot(u, mu) * dot(v, mv));
    CHECK(dot(u, mu) > 0.0);
    CHECK(dot(v, mv) > 0.0);
    CHECK(std::abs(dot(v, mu) - dot(u, mv)) < 1e-4 * scale);
    std::vector<float> sum(u.size());
    for (std::size_t n = 0; n < sum.size(); ++n) sum[n] = 2.0f * u[n] - v[n];
    std::vector<float> rest = applied(sum);
    const double size = std::sqrt(dot(rest, rest));
    for (std::size_t n = 0; n < rest.size(); ++n) rest[n] -= 2.0f * mu[n] - mv[n];
    CHECK(std::sqrt(dot(rest, rest)) < 1e-5 * size);
}

TEST_CASE("dsp: seeds in the dark do not keep the solver busy and the residual says what was reached") {
    Phantom p = noisy_cube(24);
    for (const auto& at : {std::array<int, 3>{3, 3, 3}, std::array<int, 3>{20, 20, 20}})
        for (int k = -1; k <= 1; ++k)
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i) p.grid.at(at[0] + i, at[1] + j, at[2] + k) = -5000.0f;
    const VoxelGraph graph = segmentation::make_voxel_graph(p.grid, p.inside, {700.0, 40.0, 1e-4});
    const auto seed = seeds_at(graph, {{{3, 3, 3}, 1}, {{20, 20, 20}, 2}});
    const Walks walks = segmentation::random_walks(graph, seed, 2, {1e-12, 200});
    CHECK(walks.iterations < 100);
    CHECK(walks.residual < 0.2);
    CHECK(walks.residual > 1e-9);
    check_probabilities(walks);
}

TEST_CASE("dsp: a label whose seeds are shut in is nowhere else, also from an earlier solve") {
    Phantom p;
    p.grid = {{9, 1, 1}, Vec3(0.0), Vec3(1e-3), std::vector<float>(9, 500.0f)};
    p.inside = {1, 1, 1, 0, 1, 1, 1, 1, 1};
    const VoxelGraph graph = p.graph();
    const Walks before = segmentation::random_walks(
        graph, seeds_at(graph, {{{1, 0, 0}, 1}, {{4, 0, 0}, 1}, {{8, 0, 0}, 2}, {{6, 0, 0}, 3}}), 3);
    const auto seed = seeds_at(graph, {{{0, 0, 0}, 1}, {{1, 0, 0}, 1}, {{2, 0, 0}, 1}, {{4, 0, 0}, 3}, {{8, 0, 0}, 2}});
    const Walks walks = segmentation::random_walks(graph, seed, 3, {}, &before);
    CHECK(walks.iterations < 50);
    CHECK(segmentation::labels_of(walks) == segmentation::labels_of(segmentation::random_walks(graph, seed, 3)));
    CHECK(walks.probability[3 * 5] == 0.0f);
    // All voxels are seeds.
    const std::vector<std::uint8_t> all{1, 2, 1, 2, 1, 2, 1, 2};
    CHECK(segmentation::labels_of(segmentation::random_walks(graph, all, 2)) == all);
}
