// SPDX-License-Identifier: Apache-2.0
// Parameters of a dark-gap law, estimated from the values of a scan.
#pragma once

#include "dsp/segmentation/voxel_graph.hpp"
#include "dsp/volume/grid.hpp"

#include <cstdint>
#include <span>

namespace tactus::segmentation {

/// Statistics of the values where `inside` is not 0.
struct GapStatistics {
    double dark = 0.0;    ///< 5 % of the values are below it
    double bright = 0.0;  ///< 60 % of the values are below it
    double noise = 0.0;   ///< standard deviation of the noise
};

/// Quantiles are interpolated between the occurring values, so that a coarse quantisation has little effect. The noise
/// is the median absolute value of Immerkær's operator in each layer (Computer Vision and Image Understanding 64,
/// 1996), corrected for the quantisation steps of the values; the median replaces Immerkær's mean because bone has
/// texture. All results scale with the values, within rounding.
GapStatistics gap_statistics(const volume::Grid& values, std::span<const std::uint8_t> inside);

/// Conducts fully at `bright`; falls to 1/e over twice the noise, at least over 5 % of the range from dark to bright.
/// The fractions were chosen on three scanned fractures with expert labels: docs/benchmarks.md.
GapLaw gap_law(const GapStatistics& statistics);

/// The same law, adapted to strokes in darker bone: full conductance starts at the value below which 90 % of the
/// painted voxels of the darkest label lie. Without it, a stroke in spongy bone would be enclosed by bone as dark as a
/// gap, and its whole fragment would get a label that touches its cortex. `seed`: of each node, 0 for none.
GapLaw law_of_seeds(const GapLaw& law, const VoxelGraph& graph, const volume::Grid& values,
                    std::span<const std::uint8_t> seed);

}  // namespace tactus::segmentation
