// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/mirror.hpp"

#include "dsp/core/rotation.hpp"
#include "dsp/fit/healthy_pull.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::fit {

namespace {

constexpr double least_alike_normals = 0.5;  // of two normals: 60 degrees, as in a registration

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

// The healthy side in a fit.

HealthyPull::HealthyPull(std::span<const contact::SurfacePoint> points, const HealthyPullSettings& settings)
    : settings_(settings) {
    std::vector<const contact::SurfacePoint*> outside;
    for (const contact::SurfacePoint& p : points)
        if (p.label != contact::surface_label::fracture && glm::length(p.normal) > 0.5) outside.push_back(&p);
    if (!settings.side || outside.empty()) return;
    const std::size_t stride = (outside.size() + settings.most_points - 1) / settings.most_points;
    double area = 0.0;
    for (std::size_t n = 0; n < outside.size(); n += stride) {
        links_.push_back(
            {outside[n]->position, glm::normalize(outside[n]->normal), Vec3(0.0), Vec3(0.0), outside[n]->area, 0.0});
        area += outside[n]->area;
    }
    for (Link& link : links_) link.share /= std::max(area, 1e-12);
}

void HealthyPull::look(const Pose& body) noexcept {
    const double s2 = settings_.scale * settings_.scale;
    for (Link& link : links_) {
        const Vec3 at = body.apply(link.from);
        const std::size_t nearest = settings_.side->nearest(at);
        link.to = settings_.side->position(nearest);
        link.along = settings_.side->normal(nearest);
        link.weight = 0.0;
        if (glm::dot(body.rotate(link.normal), link.along) < least_alike_normals) continue;
        const double d = glm::dot(link.along, at - link.to), share = s2 / (s2 + d * d);
        link.weight = settings_.weight * link.share * share * share;
    }
}

void HealthyPull::add(contact::ContactSum& sum, const Pose& body, const Vec3& origin, double strength) const noexcept {
    for (const Link& link : links_) {
        if (!(link.weight > 0.0)) continue;
        const Vec3 at = body.apply(link.from);
        const double d = glm::dot(link.along, at - link.to), k = strength * link.weight;
        const Vec3 turn = glm::cross(at - origin, link.along);
        const double j[6] = {link.along.x, link.along.y, link.along.z, turn.x, turn.y, turn.z};
        sum.energy += 0.5 * k * d * d;
        for (std::size_t a = 0; a < 6; ++a) {
            sum.gradient[a] += k * d * j[a];
            for (std::size_t b = 0; b < 6; ++b) sum.stiffness[6 * a + b] += k * j[a] * j[b];
        }
    }
}

}  // namespace tactus::fit
