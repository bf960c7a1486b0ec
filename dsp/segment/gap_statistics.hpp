// SPDX-License-Identifier: Apache-2.0
// Where a dark-gap law begins and how steep it is, from the values of a scan.
#pragma once

#include "dsp/segment/voxel_graph.hpp"
#include "dsp/volume/grid.hpp"

#include <cstdint>
#include <span>

namespace tactus::segment {

/// Statistics of the values where `inside` is not 0.
struct GapStatistics {
    double dark = 0.0;    ///< 5 % of the values are below it
    double bright = 0.0;  ///< 60 % of the values are below it
    double noise = 0.0;   ///< standard deviation of the noise
};

/// Quantiles are interpolated between the values that occur, so that a coarse quantisation moves them little. The noise
/// is the median absolute value of Immerkær's operator in each layer (Computer Vision and Image Understanding 64, 1996,
/// with a median in place of the mean, because bone has texture), without what the steps of the values add. All scale with
/// the values, within rounding.
GapStatistics gap_statistics(const volume::Grid& values, std::span<const std::uint8_t> inside);

/// Conducts fully at `bright`; falls to 1/e over twice the noise, at least over 5 % of the range from dark to bright. The
/// shares were chosen on three scanned fractures with expert labels: docs/benchmarks.md.
GapLaw gap_law(const GapStatistics& statistics);

/// The same law, where strokes lie in darker bone: conducts fully from the value on that 90 % of the painted voxels of the
/// darkest label are below. A stroke in spongy bone would otherwise be shut in by bone as dark as a gap, and its whole
/// fragment would go to a label that its cortex touches. `seed`: of each node, 0 for none.
GapLaw law_of_seeds(const GapLaw& law, const VoxelGraph& graph, const volume::Grid& values,
                    std::span<const std::uint8_t> seed);

}  // namespace tactus::segment
