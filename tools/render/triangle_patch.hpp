// SPDX-License-Identifier: Apache-2.0
// Triangles as a part of a mesh on the graphics card.
#pragma once

#include "dsp/geometry/brick_surface.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <array>
#include <cstdint>

namespace tactus::render {

/// The surface (m) in one colour (sRGB, 8 bits, with opacity), with normals that are means of its triangles by their areas.
geometry::SurfacePatch triangle_patch(const geometry::TriangleSurface& surface,
                                      const std::array<std::uint8_t, 4>& colour);

}  // namespace tactus::render
