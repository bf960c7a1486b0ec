// SPDX-License-Identifier: Apache-2.0
// Splits the painted fracture of a fragment into faces, one per neighbouring fragment.
#pragma once

#include "dsp/contact/pointshell.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::fit {

struct FaceOptions {
    std::uint8_t paint = contact::surface_label::fracture;
    double smooth = 3e-3;  ///< m: scale over which a face's relief is averaged out
    double max_gap = 1.5e-3;       ///< m: painted points farther apart do not touch
    double bend = 0.75;  ///< rad: largest angle between a point's normal and the mean of its face
    double min_area = 12e-6;  ///< m²: smaller faces are merged into an adjacent face, or dropped
};

/// Indices of the painted points of each face, largest face first. Fracture faces meet at edges: a point belongs to a
/// face while its normal, with the relief averaged out, is near the face's mean. Deterministic.
std::vector<std::vector<std::size_t>> split_faces(std::span<const contact::SurfacePoint> points,
                                                  const FaceOptions& options = {});

}  // namespace tactus::fit
