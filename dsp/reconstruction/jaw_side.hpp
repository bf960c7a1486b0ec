// SPDX-License-Identifier: Apache-2.0
// The jaw's side of a fibula plan: positions of its planes and segments.
#pragma once

#include "dsp/reconstruction/fibula_plan.hpp"

#include <vector>

namespace tactus::reconstruction {

/// Planes and segments in the order of the segments in the donor, from the ankle on.
struct JawSide {
    std::vector<Plane> planes;  ///< normals along the axes
    std::vector<Vec3> axis, y;  ///< of the segments
    std::vector<double> off_bisector;  ///< rad, of the inner planes
};

/// Throws Error as plan_fibula does for invalid planes.
JawSide jaw_side(const FibulaInputs& inputs);

}  // namespace tactus::reconstruction
