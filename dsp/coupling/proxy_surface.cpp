// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/proxy_surface.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tactus::coupling {

namespace {

struct Reading {
    double value = 0.0;  // m
    Vec3 gradient{0.0};
};

/// Beyond the samples that its spline needs, half a voxel from where its grid ends, a field continues as the distance to the
/// surface point next to there: a ball may be larger than the margin of the field. Nearer to the end the spline repeats
/// samples and is too flat.
Reading read(const contact::Voxmap& map, const Vec3& at) noexcept {
    const volume::Grid& grid = map.grid;
    if (grid.values.empty()) return {map.far, Vec3(0.0)};
    const Vec3 last(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1);
    const Vec3 border =
        glm::clamp(at, grid.origin + 0.5 * grid.spacing, grid.origin + (last - Vec3(0.5)) * grid.spacing);
    const volume::Sample sample = map.smooth_sample(border);
    if (border == at) return {sample.value, sample.gradient};
    // A body that reaches the border of its grid ends there.
    if (!sample.inside || sample.value <= 0.0) {
        const volume::Sample beyond = map.smooth_sample(at);
        return {beyond.value, beyond.gradient};
    }
    const double slope = glm::length(sample.gradient);
    if (slope < 0.5) return {std::max(sample.value, glm::length(at - border)), Vec3(0.0)};
    const Vec3 away = at - (border - sample.gradient * (sample.value / (slope * slope)));
    const double distance = glm::length(away);
    // In value and gradient as the field at the border.
    return {distance * slope, away * (slope / distance)};
}

}  // namespace

double ProxyTexture::max_slope() const noexcept {
    return std::numbers::pi * std::numbers::sqrt2 * used_height() / length;
}

/// Triplanar mapping: the axis nearest to the normal is left out. Between two such axes the maps are blended; `sharpness`
/// makes that zone narrow, as the blend of two maps is flatter than either.
ProxyTexture::Lift ProxyTexture::at(const Vec3& point, const Vec3& normal) const noexcept {
    constexpr double sharpness = 16.0;
    Vec3 left_out(0.0);
    const double largest = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
    for (int axis = 0; axis < 3; ++axis) left_out[axis] = std::pow(std::abs(normal[axis]) / largest, sharpness);
    left_out /= left_out.x + left_out.y + left_out.z;
    const double k = 2.0 * std::numbers::pi / length;
    const Vec3 a = point * k, half = 0.5 * used_height() * (Vec3(1.0) - left_out);
    const Vec3 slope = k * half * Vec3(std::cos(a.x), std::cos(a.y), std::cos(a.z));
    return {glm::dot(half, Vec3(std::sin(a.x), std::sin(a.y), std::sin(a.z))),
            slope - normal * glm::dot(slope, normal)};
}

ProxySurface::Level ProxySurface::level(const Vec3& at, const ProxyShape& shape) const noexcept {
    if (!map) return {false, {}, 1e3};
    const Reading reading = read(*map, pose.inverse().apply(at));
    const double above = reading.value - shape.radius;
    Level level;
    level.room = above / map->steepness;
    const double steep = glm::length(reading.gradient);
    // In the middle of a wall the gradient shows no way out.
    if (!(steep > 0.05)) return level;
    level.seen = true;
    level.plane.normal = pose.rotate(reading.gradient / steep);
    level.plane.gap = above / steep - proxy_hover;
    return level;
}

double ProxySurface::stride(const ProxyShape& shape) const noexcept {
    if (!map) return shape.step;
    const Vec3& spacing = map->grid.spacing;
    return std::min(shape.step, 0.5 * std::min({spacing.x, spacing.y, spacing.z}));
}

void ProxySurface::touched(const Vec3& at, const ProxyShape& shape, std::size_t index, ProxyPlanes& into,
                           Budget& budget) const noexcept {
    const Vec3 local = pose.inverse().apply(at);
    std::array<geometry::TriangleTree::Near, 32> near;
    const std::size_t count = triangles->all_near(local, shape.radius + proxy_hover + proxy_touch, near, budget);
    for (std::size_t i = 0; i < count; ++i) {
        if (!(near[i].distance > 0.0)) continue;
        const Vec3 out = (local - near[i].point) / near[i].distance;
        Vec3 shaded = near[i].normal;
        if (glm::dot(shaded, out) < 0.0) shaded = -shaded;
        into.add({pose.rotate(out), near[i].distance - shape.radius - proxy_hover, pose.rotate(shaded), index});
    }
}

double ProxySurface::free_distance(const Vec3& at, const Vec3& direction, double length, const ProxyShape& shape,
                                   Budget& budget) const noexcept {
    const double radius = shape.radius;
    const Pose back = pose.inverse();
    const Vec3 from = back.apply(at), along = back.rotate(direction) * length;
    const double share = triangles->sweep(from, along, radius, budget);
    if (!(share < 1.0)) return length;
    // Slightly shortened, so that the next move does not start in contact; never below half.
    const Vec3 there = from + share * along;
    const geometry::TriangleTree::Near near = triangles->nearest(there, 1.01 * radius + 2.0 * proxy_hover, budget);
    if (budget.is_spent()) return 0.0;
    const double approach = -glm::dot(along, there - near.point) / (length * std::max(near.distance, 1e-12));
    return share * length - std::min(0.5 * share * length, proxy_hover / std::max(approach, 1e-3));
}

}  // namespace tactus::coupling
