// SPDX-License-Identifier: Apache-2.0
// A recorded hand was somewhere else: bring it to where the tool rests here.
#pragma once

#include "dsp/simulate/trajectory.hpp"

#include <span>

namespace tactus::simulate {

/// Moves a recording as a whole. Where the hand worked, within 15 mm aside of its median position, its deepest
/// twentieth along `feed` (unit vector) then lies beyond `reach` (m) from the origin, the median aside of the origin
/// is 0 and the mean orientation there is no rotation. Shape, timing and every relative motion stay as recorded.
/// Nothing happens to an empty recording.
void align_to_rest(std::span<TrajectorySample> samples, const Vec3& feed, double reach);

}  // namespace tactus::simulate
