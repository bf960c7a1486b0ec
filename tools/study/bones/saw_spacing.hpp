// SPDX-License-Identifier: Apache-2.0
// Which saw can cut a bone of a given spacing.
#pragma once

#include <array>
#include <string>

namespace tactus::study {

/// Kerf of node `carve` unless a patch says otherwise, mm.
constexpr double usual_kerf_mm = 1.0;

/// Narrowest kerf that `carve` accepts in voxels of this size, mm: three of their longest side, and a little.
double narrowest_kerf_mm(const std::array<double, 3>& voxel_mm);
/// Coarsest spacing in which `carve` accepts a kerf, mm, rounded down to 0.01.
double coarsest_spacing_mm(double kerf_mm);

/// One line: a bone that the usual saw can cut, or the spacing it needs.
std::string saw_line(const std::array<double, 3>& voxel_mm);

}  // namespace tactus::study
