// SPDX-License-Identifier: Apache-2.0
// Closed tube surfaces of the branches of a track.
#pragma once

#include "dsp/geometry/iso_surface.hpp"
#include "dsp/vessel/track.hpp"

namespace tactus::vessel {

/// Returns a closed tube around the branch with its radius at each node; triangles face outwards. `sides`: corners per
/// ring, at least 3. Empty for a branch of fewer than two nodes. Tubes of adjacent branches overlap.
geometry::TriangleSurface tube_surface(const Branch& branch, int sides = 16);

}  // namespace tactus::vessel
