// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/proxy_planes.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <initializer_list>
#include <limits>

namespace tactus::coupling {

namespace {

/// Lagrange multipliers of the projection onto the planes in which all `count` gaps become zero; false when the planes
/// are linearly dependent or a multiplier would be negative.
bool corner(const Vec3& goal, const Vec3& from, const ProxyPlane* const* active, int count, Vec3& point,
            double (&x)[3]) {
    double a[3][3], b[3];
    for (int i = 0; i < count; ++i) {
        b[i] = -active[i]->gap - glm::dot(active[i]->normal, goal - from);
        for (int j = 0; j < count; ++j) a[i][j] = glm::dot(active[i]->normal, active[j]->normal);
    }
    for (int j = 0; j < count; ++j) {
        if (!(a[j][j] > 1e-9)) return false;
        for (int i = j + 1; i < count; ++i) {
            const double l = a[i][j] / a[j][j];
            for (int n = j; n < count; ++n) a[i][n] -= l * a[j][n];
            b[i] -= l * b[j];
        }
    }
    for (int i = count - 1; i >= 0; --i) {
        x[i] = b[i];
        for (int n = i + 1; n < count; ++n) x[i] -= a[i][n] * x[n];
        x[i] /= a[i][i];
        if (!(x[i] >= 0.0)) return false;
    }
    point = goal;
    for (int i = 0; i < count; ++i) point += x[i] * active[i]->normal;
    return true;
}

}  // namespace

Vec3 nearest_within(const Vec3& goal, const Vec3& from, std::span<const ProxyPlane> planes,
                    PlanePushes* pushes) noexcept {
    if (pushes) *pushes = {};
    const std::size_t count = std::min<std::size_t>(planes.size(), 8);
    const auto allowed = [&](const Vec3& x) {
        for (std::size_t i = 0; i < count; ++i)
            if (glm::dot(planes[i].normal, x - from) < -planes[i].gap - 1e-12) return false;
        return true;
    };
    if (allowed(goal)) return goal;
    Vec3 best = from, point;
    double least = std::numeric_limits<double>::infinity();
    const auto consider = [&](std::initializer_list<std::size_t> which) {
        const ProxyPlane* active[3];
        int n = 0;
        for (const std::size_t i : which) active[n++] = &planes[i];
        double push[3] = {};
        if (!corner(goal, from, active, n, point, push) || !allowed(point)) return;
        const double d2 = glm::dot(point - goal, point - goal);
        if (!(d2 < least)) return;
        least = d2;
        best = point;
        if (!pushes) return;
        *pushes = {};
        n = 0;
        for (const std::size_t i : which) (*pushes)[i] = push[n++];
    };
    for (std::size_t i = 0; i < count; ++i) {
        consider({i});
        for (std::size_t j = 0; j < i; ++j) {
            consider({i, j});
            for (std::size_t k = 0; k < j; ++k) consider({i, j, k});
        }
    }
    return best;
}

void ProxyPlanes::add(const ProxyPlane& one) noexcept {
    for (std::size_t i = 0; i < count_; ++i)
        if (glm::dot(plane_[i].normal, one.normal) > 1.0 - 1e-10) {
            plane_[i].gap = std::min(plane_[i].gap, one.gap);
            return;
        }
    if (count_ < most) {
        plane_[count_++] = one;
        return;
    }
    const auto farthest = std::ranges::max_element(plane_, {}, &ProxyPlane::gap);
    if (one.gap < farthest->gap) *farthest = one;
}

ProxyPlanes ProxyPlanes::shaded() const noexcept {
    ProxyPlanes planes;
    for (ProxyPlane plane : all()) {
        if (plane.shaded != Vec3(0.0)) plane.normal = plane.shaded;
        planes.add(plane);
    }
    return planes;
}

}  // namespace tactus::coupling
