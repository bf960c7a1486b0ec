// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/surface_proxy.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus {

namespace {

constexpr double skin = 1e-6;   // m: how far off a surface a point is held
constexpr double touch = 2e-6;  // m: what is nearer counts as touched
constexpr int most_moves = 24;

/// Lagrange multipliers of the projection on the planes where all `count` gaps become zero; false when they depend on
/// each other or one would have to pull.
bool corner(const Vec3& goal, const Vec3& from, const ProxyPlane* const* active, int count, Vec3& point) {
    double a[3][3], b[3], x[3] = {};
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

Vec3 nearest_within(const Vec3& goal, const Vec3& from, std::span<const ProxyPlane> planes) noexcept {
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
        if (!corner(goal, from, active, n, point) || !allowed(point)) return;
        const double d2 = glm::dot(point - goal, point - goal);
        if (d2 < least) least = d2, best = point;
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

void SurfaceProxy::Planes::add(const ProxyPlane& one) noexcept {
    // Neighbouring triangles of a flat face are one plane.
    for (std::size_t i = 0; i < count; ++i)
        if (glm::dot(plane[i].normal, one.normal) > 1.0 - 1e-10) {
            plane[i].gap = std::min(plane[i].gap, one.gap);
            return;
        }
    if (count < most_planes) plane[count++] = one;
}

void SurfaceProxy::reset(const Vec3& at) noexcept {
    state_ = {};
    state_.proxy = at;
    started_ = true;
}

double SurfaceProxy::radius() const noexcept { return std::max(settings.radius, skin); }

ProxyPlane SurfaceProxy::textured(const ProxySurface& surface, const Vec3& point, ProxyPlane plane) const noexcept {
    if (!(settings.texture_height > 0.0)) return plane;
    const double k = 2.0 * std::numbers::pi / settings.texture_length;
    const Vec3 at = surface.pose.inverse().apply(point) * k;
    const double height = settings.texture_height / 3.0;
    plane.gap -= height * (std::sin(at.x) + std::sin(at.y) + std::sin(at.z));
    const Vec3 slope = surface.pose.rotate(height * k * Vec3(std::cos(at.x), std::cos(at.y), std::cos(at.z)));
    plane.normal = glm::normalize(plane.normal - (slope - plane.normal * glm::dot(plane.normal, slope)));
    return plane;
}

SurfaceProxy::Planes SurfaceProxy::touched(const Vec3& at, std::span<const ProxySurface> surfaces) const noexcept {
    Planes planes;
    const double r = radius(), wave = settings.texture_height;
    for (const ProxySurface& surface : surfaces) {
        const Vec3 local = surface.pose.inverse().apply(at);
        if (surface.triangles) {
            std::array<TriangleTree::Near, 32> near;
            const std::size_t count = surface.triangles->all_near(local, r + wave + touch, near);
            for (std::size_t i = 0; i < count; ++i) {
                if (!(near[i].distance > 0.0)) continue;
                const Vec3 normal = surface.pose.rotate((local - near[i].point) / near[i].distance);
                const ProxyPlane plane =
                    textured(surface, surface.pose.apply(near[i].point), {normal, near[i].distance - r});
                if (plane.gap < touch) planes.add(plane);
            }
        } else if (surface.map) {
            const Sample sample = surface.map->smooth_sample(local);
            const double steep = glm::length(sample.gradient);
            // In the middle of a wall there is no way out to be seen.
            if (!sample.inside || !(steep > 0.05)) continue;
            const Vec3 normal = surface.pose.rotate(sample.gradient / steep);
            const double distance = sample.value / steep;
            const ProxyPlane plane = textured(surface, at - normal * distance, {normal, distance - r});
            if (plane.gap < touch) planes.add(plane);
        }
    }
    return planes;
}

double SurfaceProxy::free_way(const Vec3& at, const Vec3& way, double length,
                              std::span<const ProxySurface> surfaces) const noexcept {
    const double r = radius();
    double least = length;
    for (const ProxySurface& surface : surfaces) {
        const Pose back = surface.pose.inverse();
        if (surface.triangles && r <= 50.0 * skin) {
            // A point: what its path meets, less what keeps it off there.
            const Vec3 from = back.apply(at), to = back.apply(at + way * least);
            const double share = surface.triangles->cast(from, to);
            if (share < 1.0) least = std::max(0.0, least * share - r);
            continue;
        }
        // On from sphere to sphere of what is free; where that ends, a step so short that the way back is sure.
        double gone = 0.0;
        for (int n = 0; n < 32 && gone < least; ++n) {
            const Vec3 here = back.apply(at + way * gone);
            const double distance =
                surface.triangles
                    ? surface.triangles->nearest(here, r + settings.texture_height + least - gone).distance
                : surface.map ? surface.map->smooth_sample(here).value / surface.map->steepness
                              : length + r;
            const double room = distance - r - settings.texture_height;
            if (room < touch) break;
            gone += room;
        }
        least = std::min(least, gone + (surface.triangles ? std::min(0.5 * r, settings.step) : settings.step));
    }
    return least;
}

Vec3 SurfaceProxy::lead(Vec3 from, const Vec3& goal, std::span<const ProxySurface> surfaces) const noexcept {
    // Planes of the last places hold too: in a notch the field shows one wall at a time.
    std::array<ProxyPlane, 2> last;
    std::size_t remembered = 0;
    for (int move = 0; move < most_moves; ++move) {
        Planes planes = touched(from, surfaces);
        for (std::size_t i = 0; i < remembered; ++i) planes.add(last[i]);
        const Vec3 target = nearest_within(goal, from, std::span(planes.plane).first(planes.count));
        const double length = glm::length(target - from);
        if (!(length > 1e-9)) break;
        const Vec3 way = (target - from) / length;
        const double free = free_way(from, way, length, surfaces);
        if (!(free > 1e-10)) break;
        from += way * free;
        remembered = std::min<std::size_t>(planes.count, last.size());
        for (std::size_t i = 0; i < remembered; ++i) {
            last[i] = planes.plane[i];
            last[i].gap += glm::dot(last[i].normal, way * free);
        }
        // They are guesses at any distance: only a notch that is still touched counts.
        std::size_t kept = 0;
        for (std::size_t i = 0; i < remembered; ++i)
            if (last[i].gap < touch && free < settings.step) last[kept++] = last[i];
        remembered = kept;
    }
    return from;
}

const ProxyState& SurfaceProxy::update(const Vec3& goal, std::span<const ProxySurface> surfaces) noexcept {
    // Farther than any room: a fault, not a place.
    if (!is_finite(goal) || !(glm::length(goal) < 1e3)) return state_;
    if (!started_) reset(goal);
    const Vec3 before = state_.proxy;
    Vec3 smooth = lead(before, goal, surfaces);
    const double depth = glm::length(smooth - goal);
    state_.in_contact = depth > 10.0 * touch;
    state_.sticks = false;
    state_.normal = depth > 0.0 ? (smooth - goal) / depth : Vec3(0.0);
    if (state_.in_contact && settings.static_friction > 0.0) {
        const Vec3 lag = before - smooth - state_.normal * glm::dot(before - smooth, state_.normal);
        const double behind = glm::length(lag);
        const double dynamic = std::min(settings.dynamic_friction, settings.static_friction);
        state_.sticks = behind <= settings.static_friction * depth;
        const Vec3 back = state_.sticks ? lag : lag * (dynamic * depth / behind);
        // Back along the plane, then down on the surface again.
        const Vec3 held = smooth + back;
        smooth = lead(lead(smooth, held + state_.normal * touch, surfaces), held - state_.normal * touch, surfaces);
    } else if (!state_.in_contact) state_.normal = Vec3(0.0);
    state_.proxy = smooth;
    Vec3 force = settings.stiffness * (smooth - goal);
    const double size = glm::length(force);
    if (size > settings.max_force) force *= settings.max_force / size;
    state_.force = is_finite(force) ? force : Vec3(0.0);
    return state_;
}

}  // namespace tactus
