// SPDX-License-Identifier: Apache-2.0
// Signed distance to the sub-voxel surface of grey values.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/volume/grid.hpp"

namespace tactus {

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

}  // namespace tactus
