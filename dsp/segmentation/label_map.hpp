// SPDX-License-Identifier: Apache-2.0
// Labels on the voxels of a volume: contact faces of labels, and labels for voxels beside the graph.
#pragma once

#include "dsp/core/types.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::segmentation {

/// One label per voxel, x fastest; 0: none.
struct LabelMap {
    std::array<int, 3> size{0, 0, 0};
    std::vector<std::uint8_t> label;
};

/// Assigns the nearest label to the unlabelled voxels where `open` is not 0. Distance is the number of steps across
/// faces through such voxels; among equally near labels the one reached first wins. Voxels that no label reaches stay
/// 0. Returns the number of newly labelled voxels.
std::size_t spread(LabelMap& map, std::span<const std::uint8_t> open);

/// Marks unlabelled voxels in a closing of one label by a ball of `radius` (m), or in a hollow of that closing: marrow
/// behind thin cortex. Voxels between two labels, such as those of a fracture gap, are not marked if the gap is wider
/// than the closing.
std::vector<std::uint8_t> marrow_of(const LabelMap& map, const Vec3& spacing, double radius);

/// Faces between voxels of two labels, `a` less than `b`.
struct TouchingLabels {
    std::uint8_t a = 0, b = 0;
    std::size_t faces = 0;
    double area = 0.0;  ///< m²
};
std::vector<TouchingLabels> touching_labels(const LabelMap& map, const Vec3& spacing);

}  // namespace tactus::segmentation
