// SPDX-License-Identifier: Apache-2.0
// Which parts of a surface are one piece of bone.
#pragma once

#include "dsp/geometry/iso_surface.hpp"
#include "dsp/reconstruct/section.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::reconstruct {

/// m³, by the divergence theorem about the middle of its box, so that a shell that is open at an end has the sign of a
/// closed one; positive when triangles look outwards.
double signed_volume(const geometry::TriangleSurface& surface);

/// The body of each vertex, as the number of one of its vertices. A body is a connected shell and the cavities in it:
/// shells that look the other way than the whole surface does, such as a marrow canal, which are not connected to the
/// shell around them. A cavity in several shells belongs to the smallest. `cuts` are the planes on which shells may
/// touch; a cavity is looked for at its vertex that is farthest from them.
std::vector<std::size_t> bodies_of(const geometry::TriangleSurface& surface, std::span<const Plane> cuts);

}  // namespace tactus::reconstruct
