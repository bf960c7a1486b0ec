// SPDX-License-Identifier: Apache-2.0
// Point-to-point ICP, as a reference for comparison.
#pragma once

#include "dsp/fit/registration/registration.hpp"

#include <span>

namespace tactus::fit {

/// Result of plain ICP; the residuals are distances of points, not of surfaces.
struct PointRegistration {
    Pose pose;
    double to_points = 0.0, to_surface = 0.0;  ///< m, medians over the moving points
    int steps = 0;
};

/// Point-to-point ICP with the nearest fraction `share` of the pairs. Along smooth surfaces it converges too early,
/// because every point has some near neighbour before it reaches its own. Throws Error without points. Deterministic.
PointRegistration register_points(std::span<const contact::SurfacePoint> moving, const RegistrationTarget& fixed,
                                  const Pose& start, double share = 0.8);

}  // namespace tactus::fit
