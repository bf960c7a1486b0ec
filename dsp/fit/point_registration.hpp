// SPDX-License-Identifier: Apache-2.0
// The registration that most programs have, to compare with.
#pragma once

#include "dsp/fit/registration.hpp"

#include <span>

namespace tactus::fit {

/// What plain ICP of points says, for comparison: the nearest points' distances, not those of the surfaces.
struct PointRegistration {
    Pose pose;
    double to_points = 0.0, to_surface = 0.0;  ///< m, medians over the moving points
    int steps = 0;
};

/// Point-to-point ICP with the nearest `share` of the pairs. Along smooth surfaces it stops short: every point lies near
/// some other one long before it lies on its own. Throws Error without points. Deterministic.
PointRegistration register_points(std::span<const contact::SurfacePoint> moving, const RegistrationTarget& fixed,
                                  const Pose& start, double share = 0.8);

}  // namespace tactus::fit
