// SPDX-License-Identifier: Apache-2.0
// Sheets of bone about as thin as a voxel, in the mask of a label.
#pragma once

#include "dsp/volume/grid.hpp"

#include <functional>
#include <vector>

namespace tactus::bone {

/// Whether the sample (i, j, k) of a mask has no label at all.
using IsBackground = std::function<bool(int i, int j, int k)>;

/// Closes the sheets that hold together across edges or corners of voxels only: samples between are added, so that no
/// line between two neighbours of a sample leads through, also along a diagonal (a 26-separating sheet; Cohen-Or and
/// Kaufman 1995). A sample of another label is never added. Labelled samples end at least two samples from the border of
/// the mask (1: labelled, 0: not). Per sample of the mask: 1 for one that was added, or that lies between two of
/// background along an axis.
std::vector<char> close_thin_sheets(volume::Grid& mask, const IsBackground& is_background);

}  // namespace tactus::bone
