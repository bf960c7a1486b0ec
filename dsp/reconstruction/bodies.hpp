// SPDX-License-Identifier: Apache-2.0
// Separates a surface into bodies: connected shells with their cavities.
#pragma once

#include "dsp/geometry/iso_surface.hpp"
#include "dsp/reconstruction/section.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::reconstruction {

/// Returns the volume in m³ by the divergence theorem about the centre of the bounding box, so that a shell with an
/// open end has the sign of a closed one. Positive if triangles face outwards.
double signed_volume(const geometry::TriangleSurface& surface);

/// Returns the body of each vertex, as the index of one of its vertices. A body is a connected shell with its cavities.
/// A cavity, such as a marrow canal, is a shell that is not connected to the surrounding one and has the opposite
/// orientation to the whole surface. A cavity inside several shells belongs to the smallest. `cuts` are planes on which
/// shells may touch; a cavity is located by its vertex farthest from them.
std::vector<std::size_t> bodies_of(const geometry::TriangleSurface& surface, std::span<const Plane> cuts);

}  // namespace tactus::reconstruction
