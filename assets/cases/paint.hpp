// SPDX-License-Identifier: Apache-2.0
// Which points of a fragment lie on its fracture, when the unbroken bone is known.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"

#include <cstddef>
#include <span>

namespace tactus::cases {

/// Labels the points that lie inside of the unbroken bone by more than 0.3 mm, and those within `spill` of
/// them (m: paint beyond the rim). `into_bone` takes the points' frame to the bone's. Returns how many are labelled.
std::size_t paint_fracture(std::span<contact::SurfacePoint> points, const contact::Voxmap& bone, const Pose& into_bone,
                           double spill = 0.0);

}  // namespace tactus::cases
