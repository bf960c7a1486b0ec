// SPDX-License-Identifier: Apache-2.0
// The surface points of a bone, stored or sampled.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/contact/sample_surface.hpp"

#include <vector>

namespace tactus::bone {

/// Returns the points of the bone, or points sampled on its surface; those on its scanned border are labelled. Empty if
/// the field does not cross zero. Throws Error as contact::sample_surface does.
std::vector<contact::SurfacePoint> surface_points(const Bone& bone, const contact::SurfaceSampling& sampling = {},
                                                  const RunJobs& run = run_in_turn);

}  // namespace tactus::bone
