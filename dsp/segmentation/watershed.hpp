// SPDX-License-Identifier: Apache-2.0
// Segmentation by a watershed from seeds: a fast preview while random walks are being computed.
#pragma once

#include "dsp/segmentation/voxel_graph.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::segmentation {

/// Returns the label of each node: that of the seed with the best path to it, where the quality of a path is its
/// weakest conductance. Among equal paths the flood that arrives first wins, which is the nearest seed on a plateau
/// (Meyer's flooding, 1991, on the edges of a graph). 0 in parts without a seed. Conductances closer than 4 % count as
/// equal, and those below 1e-5 of the greatest as the least. Time is proportional to the nodes. Unlike random walks it
/// leaks through any bridge as strong as the bone. `seed`: of each node, 0 for none.
std::vector<std::uint8_t> watershed(const VoxelGraph& graph, std::span<const std::uint8_t> seed);

}  // namespace tactus::segmentation
