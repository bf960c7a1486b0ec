// SPDX-License-Identifier: Apache-2.0
#include "dsp/segmentation/voxel_graph.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::segmentation {

std::array<int, 3> VoxelGraph::place(std::size_t node) const {
    const auto nx = static_cast<std::uint32_t>(size[0]), ny = static_cast<std::uint32_t>(size[1]);
    const std::uint32_t v = voxel[node];
    return {static_cast<int>(v % nx), static_cast<int>(v / nx % ny), static_cast<int>(v / nx / ny)};
}

std::vector<std::int32_t> VoxelGraph::node_of_voxel() const {
    std::vector<std::int32_t> node(
        static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]), -1);
    for (std::size_t n = 0; n < voxel.size(); ++n) node[voxel[n]] = static_cast<std::int32_t>(n);
    return node;
}

VoxelGraph make_voxel_graph(const volume::Grid& values, std::span<const std::uint8_t> inside, const GapLaw& law) {
    VoxelGraph graph;
    graph.size = values.size;
    for (std::size_t v = 0; v < inside.size(); ++v)
        if (inside[v] != 0) graph.voxel.push_back(static_cast<std::uint32_t>(v));
    const std::vector<std::int32_t> node = graph.node_of_voxel();
    graph.next.assign(graph.nodes(), {-1, -1, -1});
    graph.weight.assign(graph.nodes(), {0.0f, 0.0f, 0.0f});

    const double least = std::min({values.spacing.x, values.spacing.y, values.spacing.z});
    const std::array<std::size_t, 3> stride{
        1, static_cast<std::size_t>(values.size[0]),
        static_cast<std::size_t>(values.size[0]) * static_cast<std::size_t>(values.size[1])};
    // The exponential of the darker voxel of a pair is that of one of them.
    std::vector<float> openness(graph.nodes());
    for (std::size_t n = 0; n < graph.nodes(); ++n) {
        const double value = static_cast<double>(values.values[graph.voxel[n]]);
        openness[n] = static_cast<float>(std::exp(-std::max(0.0, law.bright - value) / law.width) + law.least);
    }
    for (std::size_t n = 0; n < graph.nodes(); ++n) {
        const std::array<int, 3> at = graph.place(n);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (at[axis] + 1 >= values.size[axis]) continue;
            const std::int32_t other = node[graph.voxel[n] + stride[axis]];
            if (other < 0) continue;
            const double ratio = least / values.spacing[static_cast<int>(axis)];
            graph.next[n][axis] = other;
            graph.weight[n][axis] =
                static_cast<float>(ratio * ratio) * std::min(openness[n], openness[static_cast<std::size_t>(other)]);
        }
    }
    return graph;
}

std::vector<std::array<std::int32_t, 6>> neighbours_of(const VoxelGraph& graph) {
    std::vector<std::array<std::int32_t, 6>> around(graph.nodes(), {-1, -1, -1, -1, -1, -1});
    for (std::size_t n = 0; n < graph.nodes(); ++n)
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (const std::int32_t m = graph.next[n][axis]; m >= 0) {
                around[n][axis] = m;
                around[static_cast<std::size_t>(m)][axis + 3] = static_cast<std::int32_t>(n);
            }
    return around;
}

GraphParts parts_of(const VoxelGraph& graph) {
    std::vector<std::int32_t> parent(graph.nodes());
    for (std::size_t n = 0; n < parent.size(); ++n) parent[n] = static_cast<std::int32_t>(n);
    const auto root = [&](std::int32_t n) {
        while (parent[static_cast<std::size_t>(n)] != n) {
            std::int32_t& up = parent[static_cast<std::size_t>(n)];
            up = parent[static_cast<std::size_t>(up)];
            n = up;
        }
        return n;
    };
    for (std::size_t n = 0; n < graph.nodes(); ++n)
        for (const std::int32_t other : graph.next[n]) {
            if (other < 0) continue;
            const std::int32_t a = root(static_cast<std::int32_t>(n)), b = root(other);
            if (a != b) parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
        }
    GraphParts parts;
    parts.part.assign(graph.nodes(), 0);
    for (std::size_t n = 0; n < graph.nodes(); ++n) {
        const std::int32_t r = root(static_cast<std::int32_t>(n));
        // A root is the first node of its part.
        if (static_cast<std::size_t>(r) == n) {
            parts.part[n] = static_cast<std::int32_t>(parts.nodes.size());
            parts.nodes.push_back(0);
        } else parts.part[n] = parts.part[static_cast<std::size_t>(r)];
        ++parts.nodes[static_cast<std::size_t>(parts.part[n])];
    }
    return parts;
}

}  // namespace tactus::segmentation
