// SPDX-License-Identifier: Apache-2.0
// How two placed fragments lie to each other: gaps, overlap, contact.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"

#include <span>
#include <vector>

namespace tactus::fit {

struct GapSettings {
    double near = 3e-3;       ///< m: farther surfaces do not lie against each other
    double contact = 0.3e-3;  ///< m: nearer ones touch
};

struct SurfaceGap {
    double facing_area = 0.0;   ///< m² of the points' surface within `near` and looking against the other
    double contact_area = 0.0;  ///< m² of that within `contact`, or inside
    double median = 0.0, p95 = 0.0;  ///< m, signed distances over the facing area: above zero there is a gap
    double deepest = 0.0;            ///< m, that points lie inside of the other
    std::vector<float> distance;     ///< m per point, signed; infinite where nothing faces it
};

/// Points of one surface against the other bone's distances, each with its body's pose.
SurfaceGap gap_between(std::span<const contact::SurfacePoint> points, const Pose& pose, const contact::Voxmap& other,
                       const Pose& other_pose, const GapSettings& settings = {});

/// m³ that both bones fill. Voxels of the first count by the share that their distance says.
double overlap_volume(const volume::Grid& first, const Pose& pose, const contact::Voxmap& other, const Pose& other_pose);

}  // namespace tactus::fit
