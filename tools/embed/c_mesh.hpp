// SPDX-License-Identifier: Apache-2.0
// Meshes that a C program gives.
#pragma once

#include "dsp/geometry/iso_surface.hpp"
#include "tools/embed/tactus.h"

namespace tactus::embed {

/// A copy of the mesh. `what`: "moving", for messages. Throws Error for an empty mesh, values that are not finite,
/// indices without a vertex, and a mesh that is not 1 mm to 5 m across: its vertices are probably in mm.
geometry::TriangleSurface surface_of(const tactus_mesh* mesh, const char* what);

}  // namespace tactus::embed
