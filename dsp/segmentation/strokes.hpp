// SPDX-License-Identifier: Apache-2.0
// Brush strokes in a volume, and the seeds along them.
#pragma once

#include "dsp/segmentation/voxel_graph.hpp"
#include "dsp/volume/grid.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::segmentation {

/// A brush moved along a polyline. Frame of the volume, m.
struct Stroke {
    double radius = 3e-3;
    std::vector<Vec3> points;
};

/// Assigns `label` to the nodes whose voxel centre is within the radius of the line, and to the voxels that contain its
/// points if they are nodes. Returns the number of nodes that the stroke covers. `layout`: the volume of the graph; its
/// values are not read. `node_of_voxel`: of the graph.
std::size_t paint(const volume::Grid& layout, std::span<const std::int32_t> node_of_voxel, const Stroke& stroke,
                  std::uint8_t label, std::span<std::uint8_t> seed);

/// Returns whether paint() would label a node.
bool touches(const volume::Grid& layout, std::span<const std::int32_t> node_of_voxel, const Stroke& stroke);

}  // namespace tactus::segmentation
