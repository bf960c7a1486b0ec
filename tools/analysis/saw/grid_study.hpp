// SPDX-License-Identifier: Apache-2.0
// Cuts one box in voxels of several sizes, to verify that the removal does not depend on them.
#pragma once

#include "assets/bone/bone.hpp"

#include <span>
#include <vector>

namespace tactus::analysis {

struct GridStudyRow {
    double voxel = 0.0;  ///< m, of the bone
    double cut_in = 0.0;  ///< m, voxel of the cut: coarse voxels are refined at the site
    double removed = 0.0;  ///< m³
    double feed = 0.0;  ///< m/s
};

/// Returns a solid box of 20 × 12 × 60 mm like an import of its surface, offset from the grid by a part of a voxel.
bone::Bone box_of_voxels(double voxel);

/// Saws for `seconds` with `thrust` N in the middle of its broad face, across it.
std::vector<GridStudyRow> run_grid_study(std::span<const double> voxels, double thrust = 12.0, double seconds = 10.0);

}  // namespace tactus::analysis
