// SPDX-License-Identifier: Apache-2.0
// Dimension drawing of a cutting guide: two sections with its slots, letters, widths, depths, angles and holes.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/analysis/cutting_guide/plan_guide.hpp"

namespace tactus::report {

/// Above, the section across the slots at half of their depth, as seen from where the guide is put on: letters, widths as
/// measured in the mesh, distances between the walls that lie on plan, and holes with their diameters. Below, the
/// section along the bone through the middle of the slots: their depths, and their angles against the approach. To
/// scale, in mm, with a scale bar.
display::Figure guide_drawing(const analysis::PlannedGuide& guide);

}  // namespace tactus::report
