// SPDX-License-Identifier: Apache-2.0
// A line of points as a branch, for what draws and writes branches.
#pragma once

#include "dsp/vessel/track.hpp"

#include <span>

namespace tactus::vessel {

/// A branch through `points` (m) with one radius (m) and the end `End::length`. Contrast and confidence stay 0: a line
/// does not know them. Points nearer than 0.1 µm to the one before are left out, so that there may be less than two nodes.
Branch branch_of_line(std::span<const Vec3> points, double radius);

}  // namespace tactus::vessel
