// SPDX-License-Identifier: Apache-2.0
// Moves a recorded hand path to the resting tool.
#pragma once

#include "dsp/simulate/trajectory.hpp"

#include <span>

namespace tactus::simulate {

/// Rigid motion of a whole recording. Its deepest place along `feed` (unit vector) then lies `reach` (m) from the origin,
/// the sideways median is 0, and the mean orientation where the hand worked, within 15 mm sideways of its median position,
/// is the identity. Shape, timing and relative motion do not change. An empty recording stays empty.
void align_to_rest(std::span<TrajectorySample> samples, const Vec3& feed, double reach);

}  // namespace tactus::simulate
