// SPDX-License-Identifier: Apache-2.0
// The bundled fracture: a bone broken in two, made by formula so that it is free of anyone's data.
#pragma once

#include "assets/bone/bone.hpp"

#include <cstdint>
#include <vector>

namespace tactus::library {

struct FractureOptions {
    double voxel = 0.35e-3;        ///< m
    double spacing = 0.42e-3;      ///< m, of the surface points
    double roughness = 1.0e-3;     ///< m, root mean square of the fracture's height about its plane
    std::uint64_t seed = 2026;
};

/// Two bones, "left" (x < 0) and "right": a bent bar of egg-shaped section, 12 mm by 24 mm and 70 mm long, broken across
/// its middle (x = 0) along a rough surface without undercuts. Both lie where they fit. Their points are saved with them,
/// those of the fracture labelled. Deterministic.
std::vector<bone::Bone> make_fragments(const FractureOptions& options = {});

}  // namespace tactus::library
