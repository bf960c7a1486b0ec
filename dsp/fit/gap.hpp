// SPDX-License-Identifier: Apache-2.0
// Gap, overlap and contact between two placed fragments.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"

#include <span>
#include <vector>

namespace tactus::fit {

struct GapSettings {
    double near = 3e-3;  ///< m: surfaces farther away do not face each other
    double contact = 0.3e-3;  ///< m: surfaces closer than this are in contact
};

struct SurfaceGap {
    double facing_area = 0.0;  ///< m² of the points' surface within `near` with opposed normals
    double contact_area = 0.0;  ///< m² of the same within `contact`, or inside
    double median = 0.0, p95 = 0.0;  ///< m, signed distances over the facing area; positive: gap
    double deepest = 0.0;  ///< m, greatest depth of a point inside the other
    std::vector<float> distance;  ///< m per point, signed; infinite without a facing surface
};

/// Measures points of one surface against the other bone's distances, each with its body's pose.
SurfaceGap gap_between(std::span<const contact::SurfacePoint> points, const Pose& pose, const contact::Voxmap& other,
                       const Pose& other_pose, const GapSettings& settings = {});

/// Returns the volume in m³ inside both bones. Each voxel of the first is weighted by its fraction that lies in both,
/// computed from the fractions in each (by the distances) and the directions of the two surfaces. Surfaces that face
/// each other and touch have no overlap.
double overlap_volume(const volume::Grid& first, const Pose& pose, const contact::Voxmap& other,
                      const Pose& other_pose);

}  // namespace tactus::fit
