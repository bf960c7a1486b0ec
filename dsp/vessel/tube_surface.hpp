// SPDX-License-Identifier: Apache-2.0
// Branches of a track as closed tubes.
#pragma once

#include "dsp/geometry/iso_surface.hpp"
#include "dsp/vessel/track.hpp"

namespace tactus::vessel {

/// A closed tube around the branch, of its radius at each node; outward triangles. `sides` corners a ring, at least 3.
/// Empty for a branch of fewer than two nodes. Tubes of branches overlap where these meet.
geometry::TriangleSurface tube_surface(const Branch& branch, int sides = 16);

}  // namespace tactus::vessel
