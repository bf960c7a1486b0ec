// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/registration/mirror.hpp"

#include "dsp/core/rotation.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cmath>

namespace tactus::fit {

namespace {

Mat3 reflection(const Vec3& normal) { return Mat3(1.0) - 2.0 * glm::outerProduct(normal, normal); }

/// The rotation axis of an improper rotation: q n = −n.
Vec3 turned_around(const Mat3& q) {
    // Columns of (q + 1) span the plane orthogonal to n; the two with the greatest angle are the most accurate.
    const Mat3 m = q + Mat3(1.0);
    Vec3 best(0.0);
    for (int a = 0; a < 3; ++a)
        for (int b = a + 1; b < 3; ++b) {
            const Vec3 across = glm::cross(m[a], m[b]);
            if (glm::dot(across, across) > glm::dot(best, best)) best = across;
        }
    return glm::length(best) > 1e-9 ? glm::normalize(best) : Vec3(1.0, 0.0, 0.0);
}

}  // namespace

std::vector<contact::SurfacePoint> mirrored(std::span<const contact::SurfacePoint> points, const MirrorPlane& plane,
                                            const Pose& pose) {
    std::vector<contact::SurfacePoint> out(points.begin(), points.end());
    for (contact::SurfacePoint& p : out) {
        p.position = pose.apply(plane.reflect(p.position));
        p.normal = pose.rotate(plane.reflect_direction(p.normal));
    }
    return out;
}

std::vector<contact::SurfacePoint> moved(std::vector<contact::SurfacePoint> points, const Pose& pose) {
    for (contact::SurfacePoint& p : points) {
        p.position = pose.apply(p.position);
        p.normal = pose.rotate(p.normal);
    }
    return points;
}

MirrorFit fit_same_side(std::span<const contact::SurfacePoint> whole, std::span<const contact::SurfacePoint> broken,
                        const RegistrationSettings& settings) {
    MirrorFit fit;
    fit.registration = register_from_anywhere(broken, whole, RegistrationTarget(whole), settings);
    fit.pose = fit.registration.pose.inverse();
    return fit;
}

MirrorFit fit_mirror(std::span<const contact::SurfacePoint> healthy, std::span<const contact::SurfacePoint> broken,
                     const RegistrationSettings& settings) {
    // Any initial mirror will do; the registration finds the rest.
    const MirrorPlane first;
    std::vector<contact::SurfacePoint> other = mirrored(healthy, first);
    // The points' tangent planes represent the surface between them, so a subset suffices.
    const std::size_t stride = other.size() / 40'000 + 1;
    std::size_t kept = 0;
    for (std::size_t n = 0; n < other.size(); n += stride) other[kept++] = other[n];
    other.resize(kept);
    const RegistrationTarget target(other);
    MirrorFit fit;
    // The broken side is a part of the mirrored side, so its points are registered to that.
    fit.registration = register_from_anywhere(broken, other, target, settings);
    const Pose onto = fit.registration.pose.inverse();
    const Mat3 q = glm::mat3_cast(onto.orientation) * reflection(first.normal);
    Vec3 n = turned_around(q);
    if (n[std::abs(n.x) > 0.5 ? 0 : std::abs(n.y) > 0.5 ? 1 : 2] < 0.0) n = -n;
    // The midpoint of a point and its image lies in the plane.
    const Vec3 image_of_origin = onto.apply(first.reflect(Vec3(0.0)));
    fit.plane = {n, 0.5 * glm::dot(n, image_of_origin)};
    const Quat rotation = glm::normalize(glm::quat_cast(q * reflection(n)));
    // pose(reflect(x)) = onto(first.reflect(x)) for all x, hence also for points that the mirror maps to themselves.
    const Vec3 fixed_point = fit.plane.offset * n;
    fit.pose = {onto.apply(first.reflect(fixed_point)) - rotation * fixed_point, rotation};
    const Vec3 angle = rotation_between({1.0, 0.0, 0.0, 0.0}, rotation);
    fit.rotation = glm::length(angle);
    Vec3 middle(0.0);
    for (const contact::SurfacePoint& p : healthy) middle += p.position / static_cast<double>(healthy.size());
    const Vec3 at = fit.plane.reflect(middle);
    fit.glide = glm::length(fit.pose.apply(at) - at);
    return fit;
}

}  // namespace tactus::fit
