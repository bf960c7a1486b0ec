// SPDX-License-Identifier: Apache-2.0
// The interpolants of a voxmap (voxmap.hpp) in any distance grid, which is not copied.
#pragma once

#include "dsp/volume/bricks.hpp"
#include "dsp/volume/grid.hpp"

namespace tactus::contact {

/// Trilinear value of a distance grid (at least 2 samples per axis) and its exact gradient; outside the grid, 0.
volume::Sample sample_field(const volume::Grid& distance, const Vec3& position) noexcept;

/// The same with a quadratic B-spline over 27 samples (border repeated): continuous gradient.
volume::Sample smooth_sample_field(const volume::Grid& distance, const Vec3& position) noexcept;

}  // namespace tactus::contact
