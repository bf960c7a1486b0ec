// SPDX-License-Identifier: Apache-2.0
// Repairs sheets of bone about as thin as a voxel in the mask of a label.
#pragma once

#include "dsp/volume/grid.hpp"

#include <functional>
#include <vector>

namespace tactus::bone {

/// Returns whether the sample (i, j, k) of a mask has no label.
using IsBackground = std::function<bool(int i, int j, int k)>;

/// Closes sheets that are connected only across edges or corners of voxels. It adds samples until no line between two
/// neighbours of a sample passes through, also along a diagonal (a 26-separating sheet; Cohen-Or and Kaufman 1995).
/// Samples of other labels are never added. `mask` is 1 for labelled samples and 0 otherwise; labelled samples must be
/// at least two samples from its border. The result is 1 for samples that were added, or that lie between two
/// background samples along an axis.
std::vector<char> close_thin_sheets(volume::Grid& mask, const IsBackground& is_background);

}  // namespace tactus::bone
