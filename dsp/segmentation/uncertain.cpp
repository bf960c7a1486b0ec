// SPDX-License-Identifier: Apache-2.0
#include "dsp/segmentation/uncertain.hpp"

#include <algorithm>
#include <cstdint>

namespace tactus::segmentation {

std::vector<UncertainRegion> uncertain_regions(const VoxelGraph& graph, std::span<const float> certain,
                                               double certainty) {
    const auto around = neighbours_of(graph);
    const auto is_low = [&](std::size_t n) { return static_cast<double>(certain[n]) < certainty; };
    std::vector<std::int32_t> steps(graph.nodes(), -1);  // to the border of the region; -1: not reached
    std::vector<std::uint32_t> queue;
    for (std::size_t n = 0; n < graph.nodes(); ++n) {
        if (!is_low(n)) continue;
        bool at_border = false;
        for (const std::int32_t m : around[n]) at_border = at_border || m < 0 || !is_low(static_cast<std::size_t>(m));
        if (!at_border) continue;
        steps[n] = 0;
        queue.push_back(static_cast<std::uint32_t>(n));
    }
    for (std::size_t head = 0; head < queue.size(); ++head)
        for (const std::int32_t m : around[queue[head]]) {
            const auto other = static_cast<std::size_t>(m);
            if (m < 0 || !is_low(other) || steps[other] >= 0) continue;
            steps[other] = steps[queue[head]] + 1;
            queue.push_back(static_cast<std::uint32_t>(other));
        }

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
            for (const std::int32_t m : around[n]) {
                if (m < 0 || !is_low(static_cast<std::size_t>(m)) || seen[static_cast<std::size_t>(m)] != 0) continue;
                seen[static_cast<std::size_t>(m)] = 1;
                queue.push_back(static_cast<std::uint32_t>(m));
            }
        }
        regions.push_back({queue.size(), graph.place(deepest)});
    }
    std::stable_sort(regions.begin(), regions.end(),
                     [](const UncertainRegion& a, const UncertainRegion& b) { return a.nodes > b.nodes; });
    return regions;
}

}  // namespace tactus::segmentation
