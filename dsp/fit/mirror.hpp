// SPDX-License-Identifier: Apache-2.0
// The healthy side as a target: mirrored, and laid on what is left of the broken one.
#pragma once

#include "dsp/fit/registration.hpp"

#include <span>
#include <vector>

namespace tactus::fit {

/// n·x = offset, n of unit length, m.
struct MirrorPlane {
    Vec3 normal{1.0, 0.0, 0.0};
    double offset = 0.0;

    Vec3 reflect(const Vec3& p) const { return p - 2.0 * (glm::dot(normal, p) - offset) * normal; }
    Vec3 reflect_direction(const Vec3& d) const { return d - 2.0 * glm::dot(normal, d) * normal; }
};

/// The points on the other side of the mirror, normals outwards, then moved by `pose`.
std::vector<contact::SurfacePoint> mirrored(std::span<const contact::SurfacePoint> points, const MirrorPlane& plane,
                                            const Pose& pose = {});

struct MirrorFit {
    MirrorPlane plane;  ///< of the body, in the frame of both
    Pose pose;  ///< what is left to do after the mirror: the body's own asymmetry and how it lay in the scanner
    double rotation = 0.0, glide = 0.0;  ///< rad and m of that pose
    Registration registration;       ///< of the broken side's points to the mirrored healthy side
};

/// Mirrors the healthy side and lays it on the broken one's main part: p ↦ pose(reflect(p)). The plane comes from the
/// data: it is the one mirror for which least is left to do. Throws Error without points.
MirrorFit fit_mirror(std::span<const contact::SurfacePoint> healthy, std::span<const contact::SurfacePoint> broken,
                     const RegistrationSettings& settings = {});

}  // namespace tactus::fit
