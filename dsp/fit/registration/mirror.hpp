// SPDX-License-Identifier: Apache-2.0
// Mirrors the healthy side of a body and registers it to the broken side, as a target.
#pragma once

#include "dsp/fit/registration/registration.hpp"

#include <span>
#include <vector>

namespace tactus::fit {

/// The plane n·x = offset, n of unit length, m.
struct MirrorPlane {
    Vec3 normal{1.0, 0.0, 0.0};
    double offset = 0.0;

    Vec3 reflect(const Vec3& p) const { return p - 2.0 * (glm::dot(normal, p) - offset) * normal; }
    Vec3 reflect_direction(const Vec3& d) const { return d - 2.0 * glm::dot(normal, d) * normal; }
};

/// Returns mirrored points with outward normals, then moved by `pose`.
std::vector<contact::SurfacePoint> mirrored(std::span<const contact::SurfacePoint> points, const MirrorPlane& plane,
                                            const Pose& pose = {});

/// Returns points moved by `pose`.
std::vector<contact::SurfacePoint> moved(std::vector<contact::SurfacePoint> points, const Pose& pose);

struct MirrorFit {
    MirrorPlane plane;  ///< symmetry plane of the body, in the frame of both
    Pose pose;  ///< residual motion after the reflection: asymmetry of the body and its pose in the scanner
    double rotation = 0.0, glide = 0.0;  ///< rad and m of that pose
    Registration registration;       ///< of the broken side's points to the mirrored healthy side
};

/// Mirrors the healthy side and registers it to the main part of the broken one: p ↦ pose(reflect(p)). The plane is the
/// one that minimises the residual motion. Throws Error without points.
MirrorFit fit_mirror(std::span<const contact::SurfacePoint> healthy, std::span<const contact::SurfacePoint> broken,
                     const RegistrationSettings& settings = {});

/// The same without a mirror, for a bone of the same side, as of another person: p ↦ pose(p). The plane has no meaning,
/// and `rotation` and `glide` are 0.
MirrorFit fit_same_side(std::span<const contact::SurfacePoint> whole, std::span<const contact::SurfacePoint> broken,
                        const RegistrationSettings& settings = {});

}  // namespace tactus::fit
