// SPDX-License-Identifier: Apache-2.0
#include "dsp/segment/uncertain.hpp"

#include <algorithm>
#include <cstdint>

namespace tactus::segment {

namespace {

/// Neighbours of each node: those of VoxelGraph::next, and the ones before it.
struct Neighbours {
    const VoxelGraph& graph;
    std::vector<std::array<std::int32_t, 3>> before;

    explicit Neighbours(const VoxelGraph& graph_) : graph(graph_), before(graph_.nodes(), {-1, -1, -1}) {
        for (std::size_t n = 0; n < graph.nodes(); ++n)
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (graph.next[n][axis] >= 0)
                    before[static_cast<std::size_t>(graph.next[n][axis])][axis] = static_cast<std::int32_t>(n);
    }

    template <class Visit>
    void visit(std::size_t n, const Visit& visit_one) const {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            visit_one(graph.next[n][axis]);
            visit_one(before[n][axis]);
        }
    }
};

}  // namespace

std::vector<UncertainRegion> uncertain_regions(const VoxelGraph& graph, std::span<const float> certain,
                                               double certainty) {
    const Neighbours neighbours(graph);
    const auto is_low = [&](std::size_t n) { return static_cast<double>(certain[n]) < certainty; };
    std::vector<std::int32_t> steps(graph.nodes(), -1);  // to the border of the region; -1: not reached
    std::vector<std::uint32_t> queue;
    for (std::size_t n = 0; n < graph.nodes(); ++n) {
        if (!is_low(n)) continue;
        bool at_border = false;
        neighbours.visit(
            n, [&](std::int32_t m) { at_border = at_border || m < 0 || !is_low(static_cast<std::size_t>(m)); });
        if (!at_border) continue;
        steps[n] = 0;
        queue.push_back(static_cast<std::uint32_t>(n));
    }
    for (std::size_t head = 0; head < queue.size(); ++head)
        neighbours.visit(queue[head], [&](std::int32_t m) {
            const auto other = static_cast<std::size_t>(m);
            if (m < 0 || !is_low(other) || steps[other] >= 0) return;
            steps[other] = steps[queue[head]] + 1;
            queue.push_back(static_cast<std::uint32_t>(other));
        });

    std::vector<UncertainRegion> regions;
    std::vector<char> seen(graph.nodes(), 0);
    for (std::size_t first = 0; first < graph.nodes(); ++first) {
        if (!is_low(first) || seen[first] != 0) continue;
        std::size_t deepest = first;
        seen[first] = 1;
        queue.assign(1, static_cast<std::uint32_t>(first));
        for (std::size_t head = 0; head < queue.size(); ++head) {
            const std::size_t n = queue[head];
            if (steps[n] > steps[deepest]) deepest = n;
            neighbours.visit(n, [&](std::int32_t m) {
                if (m < 0 || !is_low(static_cast<std::size_t>(m)) || seen[static_cast<std::size_t>(m)] != 0) return;
                seen[static_cast<std::size_t>(m)] = 1;
                queue.push_back(static_cast<std::uint32_t>(m));
            });
        }
        regions.push_back({queue.size(), graph.place(deepest)});
    }
    std::stable_sort(regions.begin(), regions.end(),
                     [](const UncertainRegion& a, const UncertainRegion& b) { return a.nodes > b.nodes; });
    return regions;
}

}  // namespace tactus::segment
