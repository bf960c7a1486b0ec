// SPDX-License-Identifier: Apache-2.0
// Signed distance to the sub-voxel surface of grey values.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/volume/grid.hpp"

#include <functional>
#include <limits>

namespace tactus::volume {

/// Each sample replaced by the mean under a cubic B-spline of one cell's width (weights 1/6, 4/6, 1/6 per axis, border
/// repeated): standard deviation 0.58 cells. Takes off the staircase that partial volume leaves on an oblique surface
/// (0.08 cells high), for a shift of an edge of radius R of about cell² / 3R.
/// In place when the grid is moved in.
Grid smoothed(Grid grid, const RunJobs& run = run_in_turn);

/// Signed distance (m, negative where grey ≥ iso) at the samples of `grey` to the surface grey == iso. Within three
/// cells the distance is to the iso-surface of the tricubic (Catmull-Rom) interpolant, found by Newton steps from a
/// near point of it; farther away, and where the steps do not settle, it is to the nearest of discs that lie on that
/// surface, one per cell. The sign is the sample's own. All samples on one side give an infinite distance. The result
/// does not depend on how jobs are run. Memory beside the result: four bytes per sample and 24 per cell crossed.
Grid distance_to_iso(const Grid& grey, float iso, const RunJobs& run = run_in_turn);

/// Grey values of `count` layers of a volume from `first` on, as a grid of as many layers.
using LayersOfGrey = std::function<Grid(int first, int count)>;
/// Takes the distance at such layers.
using TakeLayers = std::function<void(int first, const Grid& distance)>;

struct DistanceInLayers {
    double reach = std::numeric_limits<double>::infinity();  ///< m: no distance outside is longer than this
    int at_once = 0;  ///< layers that are worked on at one time; 0: all
};

/// The same distance of a volume that is not in memory: `layout` says how large it is (its values are not read), layers of
/// grey are asked for in ascending order, each once, and layers of distance are handed over in ascending order.
/// Distances longer than `reach` are `reach`, inside they have no bound. Neither that nor the result depends on how many
/// layers are worked on at one time. Memory: eight bytes per sample of those layers and of those around them that hold
/// surface within twice the reach (or within twice the depth, where the volume is solid for longer), and 24 per cell crossed.
/// Nothing on one side of iso at all gives infinite distances.
void distance_to_iso(const Grid& layout, float iso, const DistanceInLayers& how, const LayersOfGrey& grey,
                     const TakeLayers& take, const RunJobs& run = run_in_turn);

}  // namespace tactus::volume
