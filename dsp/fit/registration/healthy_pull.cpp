// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/registration/healthy_pull.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::fit {

namespace {

constexpr double min_alike_normals = 0.5;  // of two normals: 60 degrees, as in a registration

}  // namespace

HealthyPull::HealthyPull(std::span<const contact::SurfacePoint> points, const HealthyPullSettings& settings)
    : settings_(settings) {
    std::vector<const contact::SurfacePoint*> outside;
    for (const contact::SurfacePoint& p : points)
        if (p.label != contact::surface_label::fracture && p.label != contact::surface_label::as_scanned &&
            glm::length(p.normal) > 0.5)
            outside.push_back(&p);
    if (!settings.side || outside.empty()) return;
    const std::size_t stride = (outside.size() + settings.max_points - 1) / settings.max_points;
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
        if (glm::dot(body.rotate(link.normal), link.along) < min_alike_normals) continue;
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
