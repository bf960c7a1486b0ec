// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/proxy_surface.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::coupling {

namespace {

struct Reading {
    double value = 0.0;  // m
    Vec3 gradient{0.0};
};

/// Outside of its grid a field continues as the distance to the surface point next to where the grid ends, so that a
/// ball may be larger than the margin of the field.
Reading read(const contact::Voxmap& map, const Vec3& at) noexcept {
    const volume::Sample inside = map.smooth_sample(at);
    if (inside.inside || map.grid.values.empty()) return {inside.value, inside.gradient};
    const volume::Grid& grid = map.grid;
    const Vec3 last(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1), skin = 1e-9 * grid.spacing;
    const Vec3 border = glm::clamp(at, grid.origin + skin, grid.origin + last * grid.spacing - skin);
    const volume::Sample sample = map.smooth_sample(border);
    const double slope2 = glm::dot(sample.gradient, sample.gradient);
    // A body that reaches the border of its grid ends there.
    if (!sample.inside || sample.value <= 0.0) return {map.far, Vec3(0.0)};
    if (slope2 < 0.25) return {std::max(sample.value, glm::length(at - border)), Vec3(0.0)};
    const Vec3 away = at - (border - sample.gradient * (sample.value / slope2));
    const double distance = glm::length(away);
    return {distance, away / distance};
}

struct Wave {
    double lift = 0.0;  // m
    Vec3 slope{0.0};
};

/// Waves along the two axes of the body that lie best in the surface, each with half of the height (triplanar mapping:
/// the axis nearest to the normal is left out). Between two such axes the maps are blended; `sharpness` makes that zone
/// narrow, as the blend of two maps is flatter than either.
Wave wave_at(const Vec3& point, const Vec3& normal, const ProxyShape& shape) noexcept {
    if (!(shape.texture_height > 0.0)) return {};
    constexpr double sharpness = 16.0;
    Vec3 left_out(0.0);
    const double largest = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
    for (int axis = 0; axis < 3; ++axis) left_out[axis] = std::pow(std::abs(normal[axis]) / largest, sharpness);
    left_out /= left_out.x + left_out.y + left_out.z;
    const double k = 2.0 * std::numbers::pi / shape.texture_length;
    const Vec3 a = point * k, height = 0.5 * shape.texture_height * (Vec3(1.0) - left_out);
    return {glm::dot(height, Vec3(std::sin(a.x), std::sin(a.y), std::sin(a.z))),
            k * height * Vec3(std::cos(a.x), std::cos(a.y), std::cos(a.z))};
}

}  // namespace

ProxySurface::Level ProxySurface::level(const Vec3& at, const ProxyShape& shape, Budget& budget) const noexcept {
    const Vec3 local = pose.inverse().apply(at);
    Reading reading;
    double steepness = 1.0;
    if (triangles) {
        const geometry::TriangleTree::Near near =
            triangles->nearest(local, std::numeric_limits<double>::infinity(), budget);
        if (budget.is_spent()) return {};
        reading.value = near.distance;
        if (near.distance > 0.0 && std::isfinite(near.distance))
            reading.gradient = (local - near.point) / near.distance;
    } else if (map) {
        reading = read(*map, local);
        steepness = map->steepness;
    } else return {false, {}, 1e3};
    const double above = reading.value - shape.radius - (triangles ? shape.raised() : 0.0);
    Level level;
    level.room = (above - shape.texture_height) / steepness;
    const double steep = glm::length(reading.gradient);
    // In the middle of a wall the gradient shows no way out.
    if (!(steep > 0.05)) return level;
    level.seen = true;
    const Vec3 normal = reading.gradient / steep;
    const Wave wave = wave_at(local - normal * reading.value, normal, shape);
    const Vec3 slope = wave.slope - normal * glm::dot(wave.slope, normal);
    level.plane.normal = pose.rotate(glm::normalize(normal - slope));
    level.plane.gap = (above - wave.lift) / steep / std::sqrt(1.0 + glm::dot(slope, slope)) - proxy_hover;
    return level;
}

double ProxySurface::stride(const ProxyShape& shape) const noexcept {
    double most = shape.step;
    if (map && !triangles)
        most = std::min(most, 0.5 * std::min({map->grid.spacing.x, map->grid.spacing.y, map->grid.spacing.z}));
    if (shape.texture_height > 0.0) most = std::min(most, 0.125 * shape.texture_length);
    return most;
}

void ProxySurface::touched(const Vec3& at, const ProxyShape& shape, ProxyPlanes& into, Budget& budget) const noexcept {
    const Vec3 local = pose.inverse().apply(at);
    std::array<geometry::TriangleTree::Near, 32> near;
    const std::size_t count = triangles->all_near(local, shape.radius + proxy_hover + proxy_touch, near, budget);
    for (std::size_t i = 0; i < count; ++i) {
        if (!(near[i].distance > 0.0)) continue;
        const Vec3 out = (local - near[i].point) / near[i].distance;
        Vec3 shaded = near[i].normal;
        if (glm::dot(shaded, out) < 0.0) shaded = -shaded;
        into.add({pose.rotate(out), near[i].distance - shape.radius - proxy_hover, pose.rotate(shaded)});
    }
}

double ProxySurface::free_distance(const Vec3& at, const Vec3& direction, double length, const ProxyShape& shape,
                                   Budget& budget) const noexcept {
    const double radius = shape.core();
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
