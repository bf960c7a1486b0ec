// SPDX-License-Identifier: Apache-2.0
// Regions of a graph where a segmentation is not sure, and where to look first.
#pragma once

#include "dsp/segment/voxel_graph.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::segment {

/// Nodes of low certainty that are connected across faces.
struct UncertainRegion {
    std::size_t nodes = 0;
    std::array<int, 3> deepest{0, 0, 0};  ///< the voxel with the most steps to the region's border
};

/// Regions of nodes below `certainty`, largest first; equal ones in the order of their first nodes.
/// `certain`: of each node.
std::vector<UncertainRegion> uncertain_regions(const VoxelGraph& graph, std::span<const float> certain,
                                               double certainty = 0.4);

}  // namespace tactus::segment
