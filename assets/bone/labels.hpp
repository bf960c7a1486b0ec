// SPDX-License-Identifier: Apache-2.0
// Bones from a label map, one per label.
#pragma once

#include "assets/bone/bone.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/jobs.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::bone {

/// Default colour of a label, sRGB.
Vec3 label_colour(int label);

/// Options for surface, density and grid of the bones of a label map.
struct LabelBone {
    std::optional<double> spacing{};  ///< m, all axes; default: the label map's own
    const volume::Grid* hu = nullptr;         ///< a CT in HU of the same frame (LPS), on any grid
    bool hu_is_masked = false;        ///< 0 around the bone: used for the density, not for the surface
    bool keeps_border = true;         ///< other labels are also fragments; false: they may be muscles or organs
};

/// Returns the labels of a map in ascending order, without 0. Throws Error for values that are not integers in [0,
/// 65535], and for more than 1000 different values, which indicates an image.
std::vector<int> labels_in(const volume::Grid& labels);

/// The bone of one label, on a grid in the map's frame with a margin of 5 mm and at least six samples. The surface is a
/// surface net (one vertex per cell and sheet between inside and outside samples), smoothed to remove the staircase and
/// shifted as a whole to preserve the volume of the labelled voxels. Where the label borders on background and the CT's
/// grey values cross the level that best separates both sides, the surface follows that crossing instead. Density comes
/// from the CT; without a CT it is assumed, as for a mesh. `voxels` (may be null) receives the number of labelled
/// samples. The border of the bone contains the faces between its label and other labels, if `keeps_border`. Throws
/// Error for a label without samples.
Bone bone_of_label(const volume::Grid& labels, const volume::Segment& segment, const LabelBone& how,
                   const RunJobs& run = run_in_turn, std::size_t* voxels = nullptr);

}  // namespace tactus::bone
