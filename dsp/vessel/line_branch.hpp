// SPDX-License-Identifier: Apache-2.0
// Converts a line of points to a branch, for drawing and writing.
#pragma once

#include "dsp/vessel/track.hpp"

#include <span>

namespace tactus::vessel {

/// Returns a branch through `points` (m) with one radius (m) and the end `End::length`. Contrast and confidence are 0,
/// because a line has none. Points closer than 0.1 µm to the previous one are dropped, so that fewer than two nodes may
/// remain.
Branch branch_of_line(std::span<const Vec3> points, double radius);

}  // namespace tactus::vessel
