// SPDX-License-Identifier: Apache-2.0
// A volume as a graph: its voxels are nodes, connected to their neighbours by conductances.
#pragma once

#include "dsp/volume/grid.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::segmentation {

/// Nodes in ascending order of their voxel. Each is connected to its neighbours across the six faces, if they are
/// nodes.
struct VoxelGraph {
    std::array<int, 3> size{0, 0, 0};           ///< of the volume
    std::vector<std::uint32_t> voxel;           ///< of each node: its index in the volume
    std::vector<std::array<std::int32_t, 3>> next;  ///< next node along x, y and z; -1: none
    std::vector<std::array<float, 3>> weight;   ///< conductance to `next`, greater than 0

    std::size_t nodes() const { return voxel.size(); }
    /// Returns the position of a node, in samples.
    std::array<int, 3> place(std::size_t node) const;
    /// Node of each voxel of the volume; -1: none.
    std::vector<std::int32_t> node_of_voxel() const;
};

/// A dark-gap law for conductances: exp(-max(0, bright - min(a, b)) / width) + least, for neighbours of values a and b.
/// Two bright voxels are well connected regardless of their difference; one dark voxel separates. The law uses darkness
/// instead of the difference between neighbours, because cortex is much brighter than spongy bone, and a fracture is
/// darker than both.
struct GapLaw {
    double bright = 150.0;  ///< value from which on a voxel conducts fully
    double width = 40.0;  ///< the conductance falls to 1/e over this difference; more than 0
    double least = 1e-4;  ///< keeps dark voxels connected
};

/// Graph of the voxels where `inside` is not 0; one byte per sample of `values`. Conductances along an axis are divided
/// by the square of its spacing relative to the smallest one, so that walks are isotropic in mm.
VoxelGraph make_voxel_graph(const volume::Grid& values, std::span<const std::uint8_t> inside, const GapLaw& law);

/// Returns the neighbours of each node along x, y and z: first the three after it, then the three before it; -1: none.
std::vector<std::array<std::int32_t, 6>> neighbours_of(const VoxelGraph& graph);

/// Connected components of a graph: the component of each node, numbered from 0 in the order of their first nodes.
struct GraphParts {
    std::vector<std::int32_t> part;
    std::vector<std::size_t> nodes;  ///< of each part
};
GraphParts parts_of(const VoxelGraph& graph);

}  // namespace tactus::segmentation
