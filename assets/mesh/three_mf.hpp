// SPDX-License-Identifier: Apache-2.0
// 3MF files: meshes for printers, with their unit.
#pragma once

#include "assets/mesh/write_mesh.hpp"

#include <span>
#include <string>

namespace tactus::mesh {

/// The bytes of a 3MF package (core specification 1.3): one object per surface, millimetres, LPS, with its colour as base
/// material. Surfaces must be closed and wound outwards for printers to accept them. Throws Error when the archive
/// cannot be made.
std::string three_mf_of(std::span<const ColouredSurface> surfaces);

}  // namespace tactus::mesh
