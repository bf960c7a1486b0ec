// SPDX-License-Identifier: Apache-2.0
// Regions of a graph in which a segmentation is uncertain, with a position to inspect first.
#pragma once

#include "dsp/segmentation/voxel_graph.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::segmentation {

/// A connected region (across faces) of nodes with low certainty.
struct UncertainRegion {
    std::size_t nodes = 0;
    std::array<int, 3> deepest{0, 0, 0};  ///< the voxel with the most steps to the region's border
};

/// Returns the regions of nodes below `certainty`, largest first; regions of equal size in the order of their first
/// nodes. `certain`: of each node.
std::vector<UncertainRegion> uncertain_regions(const VoxelGraph& graph, std::span<const float> certain,
                                               double certainty = 0.4);

}  // namespace tactus::segmentation
