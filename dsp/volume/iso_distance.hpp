// SPDX-License-Identifier: Apache-2.0
// Signed distance to the sub-voxel iso-surface of grey values.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/volume/grid.hpp"

#include <functional>
#include <limits>

namespace tactus::volume {

/// Smoothing by a cubic B-spline of one cell's width (weights 1/6, 4/6, 1/6 per axis, border repeated): standard
/// deviation 0.58 cells. Removes the staircase that partial volume leaves on an oblique surface (0.08 cells high);
/// shifts an edge of radius R by about cell² / 3R.
/// In place when the grid is moved in.
Grid smoothed(Grid grid, const RunJobs& run = run_in_turn);

/// Signed distance (m, negative where grey ≥ iso) at the samples of `grey` to the surface grey == iso. Within three
/// cells the distance is to the iso-surface of the tricubic (Catmull–Rom) interpolant, found by Newton steps from a
/// near surface point; farther away, and where the steps do not converge, it is to the nearest of discs on that
/// surface, one per cell. The sign is the sample's own. Infinite when all samples are on one side. The result does not
/// depend on how jobs are run. Memory beside the result: four bytes per sample and 24 per cell crossed.
Grid distance_to_iso(const Grid& grey, float iso, const RunJobs& run = run_in_turn);

/// Returns the grey values of `count` layers of a volume from `first` on, as a grid of as many layers.
using LayersOfGrey = std::function<Grid(int first, int count)>;
/// Receives the distance of such layers.
using TakeLayers = std::function<void(int first, const Grid& distance)>;

struct DistanceInLayers {
    double reach = std::numeric_limits<double>::infinity();  ///< m: outside distances are clamped to this
    int at_once = 0;  ///< layers processed at a time; 0: all
};

/// The same distance, streamed for a volume that is not in memory: `layout` gives its size (its values are not read);
/// layers of grey are requested in ascending order, each once, and layers of distance are delivered in ascending order.
/// Outside distances are clamped to `reach`; inside they are not. The result does not depend on the number of layers
/// processed at a time. Memory: eight bytes per sample of those layers and of those around them that hold surface
/// within twice the reach (or within twice the depth, where the volume is solid for longer), and 24 per cell crossed.
/// Infinite distances when one side of iso is empty.
void distance_to_iso(const Grid& layout, float iso, const DistanceInLayers& how, const LayersOfGrey& grey,
                     const TakeLayers& take, const RunJobs& run = run_in_turn);

}  // namespace tactus::volume
