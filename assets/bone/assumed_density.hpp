// SPDX-License-Identifier: Apache-2.0
// Assumed density for bones whose source has none, such as meshes.
#pragma once

#include "dsp/volume/grid.hpp"

#include <string>

namespace tactus::bone {

/// Density in kg/m³ from the signed distance: cortex to 2 mm depth, then falling smoothly to the core at 3 mm
/// (smoothstep); 0 outside. This is an assumption, not a measurement.
volume::Grid assumed_density(const volume::Grid& distance);
/// The same law as text.
std::string assumed_density_law();

}  // namespace tactus::bone
