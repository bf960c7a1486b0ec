// SPDX-License-Identifier: Apache-2.0
// Density of bones that come without one.
#pragma once

#include "dsp/volume/grid.hpp"

#include <string>

namespace tactus::bone {

/// kg/m³ from signed distance: a cortex over the outer 2 mm that falls to a core at 3 mm, 0 outside. An assumption.
volume::Grid assumed_density(const volume::Grid& distance);
/// The same in words.
std::string assumed_density_law();

}  // namespace tactus::bone
