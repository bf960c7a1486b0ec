// SPDX-License-Identifier: Apache-2.0
// The surface points of a bone, whether its file has them or not.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/contact/sample_surface.hpp"

#include <vector>

namespace tactus::bone {

/// The points of the bone, or points sampled on its surface; those on its scanned border are marked. Empty when nothing
/// crosses zero. Throws Error as contact::sample_surface does.
std::vector<contact::SurfacePoint> surface_points(const Bone& bone, const contact::SurfaceSampling& sampling = {});

}  // namespace tactus::bone
