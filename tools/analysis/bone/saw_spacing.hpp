// SPDX-License-Identifier: Apache-2.0
// Relation between the spacing of a bone and the kerf of a saw that can cut it.
#pragma once

#include <array>
#include <string>

namespace tactus::analysis {

/// Default kerf of node `carve`, mm.
constexpr double usual_kerf_mm = 1.0;

/// Narrowest kerf that `carve` accepts in voxels of this size, mm: slightly more than three of their longest side.
double narrowest_kerf_mm(const std::array<double, 3>& voxel_mm);
/// Coarsest spacing in which `carve` accepts a kerf, mm, rounded down to 0.01.
double coarsest_spacing_mm(double kerf_mm);

/// Returns one line: that the default saw can cut the bone, or the spacing it would need.
std::string saw_line(const std::array<double, 3>& voxel_mm);

}  // namespace tactus::analysis
