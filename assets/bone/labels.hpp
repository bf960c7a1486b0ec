// SPDX-License-Identifier: Apache-2.0
// From a label map to bones, one per label.
#pragma once

#include "assets/bone/bone.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/jobs.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::bone {

/// The colour of a label that has none of its own, sRGB.
Vec3 label_colour(int label);

/// How the bones of a label map get their surface, density and grid.
struct LabelBone {
    std::optional<double> spacing{};  ///< m, all axes; default: the label map's own
    const volume::Grid* hu = nullptr;         ///< a CT in HU of the same frame (LPS), on any grid
    bool hu_is_masked = false;        ///< 0 around the bone: good for density, not for the surface
};

/// The labels of a map in ascending order, without 0. Throws Error for values that are no whole numbers in [0, 65535]
/// and for more than 1000 different ones: then it is no label map.
std::vector<int> labels_in(const volume::Grid& labels);

/// The bone of one label, on a grid of the map's frame with five millimetres and six samples of room. The surface is a
/// net of one vertex per cell and sheet between samples that are in and out, with the staircase taken off and the volume
/// of the labelled voxels kept by a shift of the whole surface. Where the neighbour is no other label and the CT's grey
/// values cross the level that splits the two sides best, the surface goes to that crossing instead. Density from the
/// CT, without one as in a mesh. `voxels` (may be null) takes the number of labelled samples. Throws Error for a label
/// without samples.
Bone bone_of_label(const volume::Grid& labels, const volume::Segment& segment, const LabelBone& how,
                   const RunJobs& run = run_in_turn, std::size_t* voxels = nullptr);

}  // namespace tactus::bone
