// SPDX-License-Identifier: Apache-2.0
// Labels the fracture points of a fragment when the unbroken bone is known.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"

#include <cstddef>
#include <span>

namespace tactus::plan {

/// Labels the points deeper than 0.3 mm inside the unbroken bone, and those within `spill` of them (m: paint beyond the
/// rim). `into_bone` maps the points' frame to the bone's. Returns the number of labelled points.
std::size_t paint_fracture(std::span<contact::SurfacePoint> points, const contact::Voxmap& bone, const Pose& into_bone,
                           double spill = 0.0);

}  // namespace tactus::plan
