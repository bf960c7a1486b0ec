// SPDX-License-Identifier: Apache-2.0
#include "dsp/segmentation/propose_seeds.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>

namespace tactus::segmentation {

namespace {

constexpr std::int32_t none = -1;

using Around = std::vector<std::array<std::int32_t, 6>>;  // neighbours of each node

/// Depth of each node below the surface of the bright nodes: steps across faces, 0 for the dark ones.
std::vector<std::int32_t> depths(const VoxelGraph& graph, const Around& around, const std::vector<char>& bright) {
    std::vector<std::int32_t> depth(graph.nodes(), none);
    std::vector<std::uint32_t> queue;
    for (std::size_t n = 0; n < graph.nodes(); ++n) {
        if (bright[n] == 0) {
            depth[n] = 0;
            continue;
        }
        bool at_border = false;
        for (const std::int32_t m : around[n])
            at_border = at_border || m < 0 || bright[static_cast<std::size_t>(m)] == 0;
        if (!at_border) continue;
        depth[n] = 1;
        queue.push_back(static_cast<std::uint32_t>(n));
    }
    for (std::size_t head = 0; head < queue.size(); ++head)
        for (const std::int32_t m : around[queue[head]])
            if (m >= 0 && depth[static_cast<std::size_t>(m)] == none) {
                depth[static_cast<std::size_t>(m)] = depth[queue[head]] + 1;
                queue.push_back(static_cast<std::uint32_t>(m));
            }
    return depth;
}

/// Connected nodes deeper than `level`, and the node of a core nearest to each node.
struct Cores {
    std::vector<std::vector<std::uint32_t>> nodes;
    std::vector<std::int32_t> nearest;  ///< core of each node; -1: in a part of the graph without one
};

Cores cores_at(const VoxelGraph& graph, const Around& around, const std::vector<std::int32_t>& depth,
               std::int32_t level) {
    Cores cores;
    std::vector<std::int32_t>& core = cores.nearest;
    core.assign(graph.nodes(), none);
    std::vector<std::uint32_t> queue, all;
    for (std::size_t first = 0; first < graph.nodes(); ++first) {
        if (depth[first] <= level || core[first] != none) continue;
        const auto number = static_cast<std::int32_t>(cores.nodes.size());
        queue.assign(1, static_cast<std::uint32_t>(first));
        core[first] = number;
        for (std::size_t head = 0; head < queue.size(); ++head)
            for (const std::int32_t m : around[queue[head]])
                if (m >= 0 && depth[static_cast<std::size_t>(m)] > level && core[static_cast<std::size_t>(m)] == none) {
                    core[static_cast<std::size_t>(m)] = number;
                    queue.push_back(static_cast<std::uint32_t>(m));
                }
        all.insert(all.end(), queue.begin(), queue.end());
        cores.nodes.push_back(queue);
    }
    for (std::size_t head = 0; head < all.size(); ++head)
        for (const std::int32_t m : around[all[head]])
            if (m >= 0 && core[static_cast<std::size_t>(m)] == none) {
                core[static_cast<std::size_t>(m)] = core[all[head]];
                all.push_back(static_cast<std::uint32_t>(m));
            }
    return cores;
}

/// Joins regions until every pair is joined weakly: the conductance between two, relative to the surface of a ball of
/// the size of the smaller one. Returns the joined region of each.
std::vector<std::int32_t> join_strongly_joined(const VoxelGraph& graph, const Cores& cores, double weakest) {
    const std::size_t count = cores.nodes.size();
    std::vector<double> size(count, 0.0);
    std::vector<std::map<std::int32_t, double>> between(count);
    for (std::size_t n = 0; n < graph.nodes(); ++n) {
        const std::int32_t a = cores.nearest[n];
        if (a < 0) continue;
        size[static_cast<std::size_t>(a)] += 1.0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int32_t m = graph.next[n][axis];
            const std::int32_t b = m < 0 ? none : cores.nearest[static_cast<std::size_t>(m)];
            if (b < 0 || b == a) continue;
            between[static_cast<std::size_t>(a)][b] += static_cast<double>(graph.weight[n][axis]);
            between[static_cast<std::size_t>(b)][a] += static_cast<double>(graph.weight[n][axis]);
        }
    }
    std::vector<std::int32_t> into(count);
    std::iota(into.begin(), into.end(), 0);
    for (;;) {
        double strongest = weakest;
        std::size_t one = count, other = count;
        for (std::size_t a = 0; a < count; ++a)
            for (const auto& [b, conductance] : between[a]) {
                const auto c = static_cast<std::size_t>(b);
                const double strength = conductance / std::pow(std::min(size[a], size[c]), 2.0 / 3.0);
                if (c > a && strength > strongest) strongest = strength, one = a, other = c;
            }
        if (one == count) break;
        const auto gone = static_cast<std::int32_t>(other), kept = static_cast<std::int32_t>(one);
        for (const auto& [b, conductance] : between[other]) {
            const auto c = static_cast<std::size_t>(b);
            between[c].erase(gone);
            if (b == kept) continue;
            between[one][b] += conductance;
            between[c][kept] += conductance;
        }
        between[other].clear();
        size[one] += size[other];
        for (std::int32_t& region : into)
            if (region == gone) region = kept;
    }
    return into;
}

/// Places of a core that are far from each other, the deepest first.
std::vector<Stroke> strokes_in(const std::vector<std::uint32_t>& core, const VoxelGraph& graph,
                               const volume::Grid& layout, const std::vector<std::int32_t>& depth, std::size_t most) {
    const double h = std::min({layout.spacing.x, layout.spacing.y, layout.spacing.z});
    const auto position = [&](std::uint32_t n) {
        const auto at = graph.place(n);
        return layout.position(at[0], at[1], at[2]);
    };
    std::vector<double> distance(core.size(), std::numeric_limits<double>::infinity());
    std::size_t next = 0;
    for (std::size_t n = 0; n < core.size(); ++n)
        if (depth[core[n]] > depth[core[next]]) next = n;
    std::vector<Stroke> strokes;
    while (strokes.size() < most && distance[next] > 6.0 * h) {
        const Vec3 place = position(core[next]);
        const double radius = h * std::clamp(static_cast<double>(depth[core[next]]) - 0.5, 1.0, 3.0);
        strokes.push_back({radius, {place}});
        for (std::size_t n = 0; n < core.size(); ++n)
            distance[n] = std::min(distance[n], glm::length(position(core[n]) - place));
        next = static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) - distance.begin());
    }
    return strokes;
}

std::vector<ProposedFragment> fragments_of(const VoxelGraph& graph, const volume::Grid& values,
                                           const std::vector<std::int32_t>& depth, const Cores& cores,
                                           const ProposeSeeds& how, double least) {
    const std::vector<std::int32_t> into = join_strongly_joined(graph, cores, how.weakest);
    std::vector<std::vector<std::uint32_t>> core(cores.nodes.size());
    std::vector<std::size_t> nodes(cores.nodes.size(), 0);
    for (std::size_t c = 0; c < cores.nodes.size(); ++c) {
        auto& all = core[static_cast<std::size_t>(into[c])];
        all.insert(all.end(), cores.nodes[c].begin(), cores.nodes[c].end());
    }
    for (const std::int32_t c : cores.nearest)
        if (c >= 0) ++nodes[static_cast<std::size_t>(into[static_cast<std::size_t>(c)])];
    std::vector<ProposedFragment> fragments;
    for (std::size_t c = 0; c < core.size(); ++c)
        if (static_cast<double>(nodes[c]) > least)
            fragments.push_back({strokes_in(core[c], graph, values, depth, how.strokes), nodes[c]});
    std::stable_sort(fragments.begin(), fragments.end(),
                     [](const ProposedFragment& a, const ProposedFragment& b) { return a.nodes > b.nodes; });
    return fragments;
}

}  // namespace

std::vector<ProposedFragment> propose_seeds(const VoxelGraph& graph, const volume::Grid& values, const GapLaw& law,
                                            const ProposeSeeds& how) {
    const Around around = neighbours_of(graph);
    // A gap darkens its voxels by several widths; spongy bone seldom does.
    const double dark = law.bright - 6.0 * law.width;
    std::vector<char> bright(graph.nodes());
    for (std::size_t n = 0; n < graph.nodes(); ++n)
        bright[n] = static_cast<double>(values.values[graph.voxel[n]]) >= dark;
    const std::vector<std::int32_t> depth = depths(graph, around, bright);

    const double h = std::min({values.spacing.x, values.spacing.y, values.spacing.z});
    const double least = how.min_share * static_cast<double>(graph.nodes());
    // Thin bone has no deep cores.
    for (auto level = std::max(1, static_cast<std::int32_t>(how.depth / h)); level > 0; --level) {
        const Cores cores = cores_at(graph, around, depth, level);
        const auto without = std::count(cores.nearest.begin(), cores.nearest.end(), none);
        if (static_cast<double>(without) > how.max_without_core * static_cast<double>(graph.nodes())) continue;
        std::vector<ProposedFragment> fragments = fragments_of(graph, values, depth, cores, how, least);
        if (fragments.size() > 1 || level == 1) return fragments;
    }
    return {};
}

}  // namespace tactus::segmentation
