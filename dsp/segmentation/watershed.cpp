// SPDX-License-Identifier: Apache-2.0
#include "dsp/segmentation/watershed.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <deque>

namespace tactus::segmentation {

namespace {

constexpr std::uint32_t levels = 272;  // 17 octaves of 16 steps

}  // namespace

std::vector<std::uint8_t> watershed(const VoxelGraph& graph, std::span<const std::uint8_t> seed) {
    float greatest = 0.0f;
    for (const auto& weights : graph.weight)
        for (const float weight : weights) greatest = std::max(greatest, weight);
    // The bits of a float grow like its logarithm; four bits of the mantissa are kept.
    const auto level_of = [top = std::bit_cast<std::uint32_t>(greatest)](float weight) {
        const std::uint32_t below = (top - std::bit_cast<std::uint32_t>(weight)) >> 19;
        return levels - 1 - std::min(below, levels - 1);
    };
    // The node before each along an axis is found by its `next`, so that only one more list is needed.
    std::vector<std::array<std::int32_t, 3>> before(graph.nodes(), {-1, -1, -1});
    for (std::size_t n = 0; n < graph.nodes(); ++n)
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (const std::int32_t m = graph.next[n][axis]; m >= 0)
                before[static_cast<std::size_t>(m)][axis] = static_cast<std::int32_t>(n);

    struct Step {
        std::int32_t node;
        std::uint8_t label;
    };
    std::array<std::deque<Step>, levels> queue;
    std::vector<std::uint8_t> label(graph.nodes(), 0);
    std::uint32_t level = levels - 1;
    const auto leave = [&](std::size_t n) {
        const auto flow = [&](std::int32_t m, float weight) {
            if (m >= 0 && label[static_cast<std::size_t>(m)] == 0)
                queue[std::min(level, level_of(weight))].push_back({m, label[n]});
        };
        for (std::size_t axis = 0; axis < 3; ++axis) {
            flow(graph.next[n][axis], graph.weight[n][axis]);
            const std::int32_t m = before[n][axis];
            if (m >= 0) flow(m, graph.weight[static_cast<std::size_t>(m)][axis]);
        }
    };
    for (std::size_t n = 0; n < graph.nodes(); ++n) label[n] = seed[n];
    for (std::size_t n = 0; n < graph.nodes(); ++n)
        if (seed[n] != 0) leave(n);
    for (;; --level) {
        for (auto& here = queue[level]; !here.empty(); here.pop_front()) {
            const Step step = here.front();
            const auto n = static_cast<std::size_t>(step.node);
            if (label[n] != 0) continue;
            label[n] = step.label;
            leave(n);
        }
        if (level == 0) return label;
    }
}

}  // namespace tactus::segmentation
