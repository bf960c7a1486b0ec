// SPDX-License-Identifier: Apache-2.0
// The painted fracture of a fragment from the middle of a bone, one face per neighbour that it broke from.
#pragma once

#include "dsp/contact/pointshell.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::fit {

struct FaceOptions {
    std::uint8_t paint = contact::surface_label::fracture;
    double smooth = 3e-3;        ///< m: over which a face's relief is averaged out
    double max_gap = 1.5e-3;       ///< m: painted points farther apart do not touch
    double bend = 0.75;          ///< rad: a point looks no farther away than this from the mean of its face
    double least_area = 12e-6;   ///< m²: smaller faces go to the neighbour they touch, or are left out
};

/// Indices of the painted points of each face, largest face first. Broken surfaces meet at edges: points belong to one
/// face as long as their normals, relief averaged out, look its way. Deterministic.
std::vector<std::vector<std::size_t>> split_faces(std::span<const contact::SurfacePoint> points,
                                                  const FaceOptions& options = {});

}  // namespace tactus::fit
