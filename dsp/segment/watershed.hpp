// SPDX-License-Identifier: Apache-2.0
// Segmentation by a watershed from seeds: labels at once, while random walks are being computed.
#pragma once

#include "dsp/segment/voxel_graph.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::segment {

/// Label of each node: that of the seed from which the path with the strongest weakest conductance leads to it; of
/// equally strong ones the one that the flood takes first, which is the nearest on a plateau (Meyer's flooding, 1991, on
/// the edges of a graph). 0 in parts without a seed. Conductances closer than 4 % count as equal, and those below 1e-5 of the greatest as the least. Time is proportional to
/// the nodes. Unlike random walks it leaks through any bridge as strong as the bone.
/// `seed`: of each node, 0 for none.
std::vector<std::uint8_t> watershed(const VoxelGraph& graph, std::span<const std::uint8_t> seed);

}  // namespace tactus::segment
