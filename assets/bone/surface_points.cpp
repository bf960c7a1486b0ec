// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/surface_points.hpp"

namespace tactus::bone {

std::vector<contact::SurfacePoint> surface_points(const Bone& bone, const contact::SurfaceSampling& sampling,
                                                  const RunJobs& run) {
    std::vector<contact::SurfacePoint> points =
        bone.points.empty() ? contact::sample_surface(bone.distance, sampling, run) : bone.points;
    contact::mark_as_scanned(points, bone.border);
    return points;
}

}  // namespace tactus::bone
