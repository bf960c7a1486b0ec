// SPDX-License-Identifier: Apache-2.0
// Samples of one grid at the places of another.
#pragma once

#include "dsp/volume/grid.hpp"

namespace tactus {

/// Values of `grid` at the samples of `layout`, axis by axis with Catmull and Rom's cubic (border repeated). Along an
/// axis where `layout` is coarser the cubic is widened to it, so that nothing aliases. Samples that both grids share
/// along all axes keep their bits, and the memory when all of them do.
Grid resampled(const Grid& grid, const Grid& layout);
Grid resampled(Grid&& grid, const Grid& layout);

}  // namespace tactus
