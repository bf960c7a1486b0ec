// SPDX-License-Identifier: Apache-2.0
// Resamples a grid at the samples of another.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/volume/grid.hpp"

namespace tactus::volume {

/// Returns the values of `grid` at the samples of `layout`, axis by axis with Catmull–Rom cubics (border repeated),
/// limited to the range of the interpolated samples. Along an axis where `layout` is coarser, the cubic is widened
/// accordingly, against aliasing. Samples common to both grids along all axes keep their bits, and the memory is reused
/// if all of them do.
Grid resampled(const Grid& grid, const Grid& layout);
Grid resampled(Grid&& grid, const Grid& layout);

/// A range of layers of a volume.
struct LayerRange {
    int first, count;
};

/// Returns the layers of `from` that resampled_layers needs for those of `layout`.
LayerRange layers_for(const Grid& from, const Grid& layout, LayerRange wanted);

/// The same for some layers, with the same bits: `grid` holds the layers that layers_for returns. The values of `from`
/// and `layout` are not used.
Grid resampled_layers(Grid grid, const Grid& from, const Grid& layout, LayerRange wanted,
                      const RunJobs& run = run_in_turn);

}  // namespace tactus::volume
