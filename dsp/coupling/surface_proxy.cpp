// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/surface_proxy.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::coupling {

namespace {

constexpr double settled = 1e-9;  // m: a shorter move counts as none
constexpr int max_moves = 200;
constexpr double regrip = 0.8;  // of the sliding cone: a proxy this far inside is at rest

}  // namespace

void SurfaceProxy::reset(const Vec3& at) noexcept {
    state_ = {};
    friction_ = unset;
    stride_ = far;
    wave_ = {};
    state_.proxy = at_ = at;
    started_ = true;
    seen_count_ = 0;
}

SurfaceProxy::View SurfaceProxy::look(const Vec3& at, std::span<const ProxySurface> surfaces) noexcept {
    View view;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        if (surfaces[i].triangles) {
            surfaces[i].touched(at, shape_, i, view.planes, budget_);
            continue;
        }
        view.levels[i] = surfaces[i].level(at, shape_);
        view.levels[i].plane.surface = i;
        if (view.levels[i].seen && view.levels[i].plane.gap < proxy_touch) view.planes.add(view.levels[i].plane);
    }
    for (const ProxyPlane& plane : view.planes.all()) view.deepest = std::max(view.deepest, -plane.gap);
    return view;
}

ProxyTexture::Lift SurfaceProxy::lift(const Vec3& at, const Vec3& goal,
                                      std::span<const ProxySurface> surfaces) const noexcept {
    const View& view = last_view_;
    PlanePushes pushes;
    nearest_within(goal, at, view.planes.all(), &pushes);
    ProxyTexture::Lift sum;
    double all = 0.0;
    for (std::size_t i = 0; i < view.planes.all().size(); ++i) {
        if (!(pushes[i] > 0.0)) continue;
        const ProxyPlane& plane = view.planes.all()[i];
        const Pose& pose = surfaces[plane.surface].pose;
        // Below the hand in this plane: in a corner the proxy stays while the hand moves on.
        const Vec3 lag = goal - at - plane.normal * glm::dot(goal - at, plane.normal);
        const Vec3 foot = at + lag - plane.normal * (shape_.radius + plane.gap);
        const Pose back = pose.inverse();
        const ProxyTexture::Lift one = settings.texture.at(back.apply(foot), back.rotate(plane.normal));
        sum.height += pushes[i] * one.height;
        sum.slope += pushes[i] * pose.rotate(one.slope);
        all += pushes[i];
    }
    if (all > 0.0) {
        sum.height /= all;
        sum.slope /= all;
    }
    return sum;
}

Vec3 SurfaceProxy::settle(Vec3 at, std::span<const ProxySurface> surfaces) noexcept {
    for (int round = 0; round < 8; ++round) {
        bool moved = false;
        for (const ProxySurface& surface : surfaces) {
            if (surface.triangles) continue;
            const ProxySurface::Level level = surface.level(at, shape_);
            if (!level.seen || level.plane.gap > -0.5 * proxy_hover) continue;
            const Vec3 out = level.plane.normal * -level.plane.gap;
            const double length = glm::length(out);
            double free = length;
            for (const ProxySurface& other : surfaces)
                if (other.triangles) free = other.free_distance(at, out / length, free, shape_, budget_);
            at += out * (free / length);
            moved = true;
        }
        if (!moved) break;
    }
    return at;
}

bool SurfaceProxy::is_open(const Vec3& a, const View& from, const Vec3& b, const View& to,
                           std::span<const ProxySurface> surfaces) noexcept {
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        if (surfaces[i].triangles || !surfaces[i].map) continue;
        const ProxySurface::Level &here = from.levels[i], &there = to.levels[i];
        if (here.room > glm::length(b - a)) continue;
        if (here.seen && there.seen && glm::dot(here.plane.normal, there.plane.normal) > 0.0) continue;
        // Two opposite walls, or both sides of a thin one: in the middle the field decides.
        const double middle = surfaces[i].level(0.5 * (a + b), shape_).room;
        if (middle < std::min(here.room, there.room)) return false;
    }
    return true;
}

Vec3 SurfaceProxy::lead(Vec3 from, const Vec3& goal, std::span<const ProxySurface> surfaces) noexcept {
    View here = look(from, surfaces);
    has_view_ = !budget_.is_spent();
    double share = 1.0;  // of the distance to try: reduced after a move that made no progress
    for (int move = 0; move < max_moves; ++move) {
        Vec3 wanted = goal;
        if (settings.shading) wanted = nearest_within(goal, from, here.planes.shaded().all());
        const Vec3 target = nearest_within(wanted, from, here.planes.all());
        const double length = glm::length(target - from);
        if (!(length > settled)) break;
        const Vec3 direction = (target - from) / length;
        double free = std::min(length * share, stride_);
        for (std::size_t i = 0; i < surfaces.size(); ++i) {
            if (!surfaces[i].triangles)
                free = std::min(free, std::max(here.levels[i].room, share * surfaces[i].stride(shape_)));
        }
        // One move may spend a part of the budget: a shorter one tests fewer triangles.
        const double tried = free;
        ProxySurface::Budget part{std::min(budget_.triangles, max_triangles / 4)};
        const std::int64_t given = part.triangles;
        for (const ProxySurface& surface : surfaces)
            if (surface.triangles) free = surface.free_distance(from, direction, free, shape_, part);
        budget_.triangles -= given - part.triangles;
        if (part.is_spent()) {
            // The remainder of a budget is no measure for the step length.
            if (given < max_triangles / 4) break;
            stride_ = std::max(0.25 * tried, settled);
            continue;
        }
        if (stride_ < far && 4 * (given - part.triangles) < given) stride_ *= 2.0;
        const Vec3 next = settle(from + direction * free, surfaces);
        const View there = look(next, surfaces);
        if (budget_.is_spent()) break;
        const bool gets_out = here.deepest > proxy_touch && there.deepest < here.deepest;
        const bool gets_near = glm::length(next - wanted) < glm::length(from - wanted) - 1e-3 * settled;
        if (!(gets_out || (gets_near && there.deepest < proxy_touch)) || !is_open(from, here, next, there, surfaces)) {
            share *= 0.5;
            if (share * length < settled) break;
            continue;
        }
        from = next;
        here = there;
        share = std::min(1.0, 2.0 * share);
    }
    last_view_ = here;
    return from;
}

void SurfaceProxy::follow(std::span<const ProxySurface> surfaces) noexcept {
    if (surfaces.size() == seen_count_)
        for (std::size_t i = 0; i < surfaces.size(); ++i) {
            const ProxySurface &now = surfaces[i], &then = seen_[i];
            if (now.map != then.map || now.triangles != then.triangles) continue;
            if (now.pose.position == then.pose.position && now.pose.orientation == then.pose.orientation) continue;
            // In the frame of the surface the proxy moves.
            const ProxySurface at_rest{now.map, now.triangles, {}};
            const Vec3 from = then.pose.inverse().apply(at_), to = now.pose.inverse().apply(at_);
            at_ = now.pose.apply(lead(from, to, {&at_rest, 1}));
        }
    seen_count_ = surfaces.size();
    std::ranges::copy(surfaces, seen_.begin());
}

double SurfaceProxy::held_back(double behind, double depth) noexcept {
    const double most = settings.static_friction, least = std::min(settings.dynamic_friction, most);
    friction_ = friction_ >= 0.0 ? std::clamp(friction_, least, most) : most;
    state_.sticks = behind <= friction_ * depth;
    if (state_.sticks) {
        if (behind <= regrip * least * depth) friction_ = most;
        return behind;
    }
    // The coefficient falls by one for a slide of twice the depth: at that slope the force of friction falls as fast as
    // the spring's rises, so that it stays a continuous function of the hand's position. Solved for the end of the slide.
    friction_ = std::max(least, 2.0 * friction_ - behind / depth);
    return friction_ * depth;
}

const ProxyState& SurfaceProxy::update(const Vec3& goal, std::span<const ProxySurface> surfaces) noexcept {
    // Farther than any room: an input fault. The proxy waits where it is, without a force.
    if (!is_finite(goal) || !(glm::length(goal) < 1e3)) {
        state_.force = state_.normal = Vec3(0.0);
        state_.in_contact = state_.sticks = false;
        return state_;
    }
    if (!started_) reset(goal);
    surfaces = surfaces.first(std::min(surfaces.size(), max_surfaces));
    const ProxyTexture& texture = settings.texture;
    const double crest = texture.used_height();
    shape_ = settings.shape;
    shape_.radius = std::max(shape_.radius, point_radius) + crest;
    budget_.triangles = max_triangles;
    follow(surfaces);
    const Vec3 before = at_;
    Vec3 smooth = lead(before, goal, surfaces);
    const double distance = glm::length(smooth - goal);
    state_.normal = distance > proxy_touch ? (smooth - goal) / distance : Vec3(0.0);
    // Without a view the proxy has not moved, and is on the wave on which it was.
    if (!(crest > 0.0 && distance > proxy_touch)) wave_ = {};
    else if (has_view_) wave_ = lift(smooth, goal, surfaces);
    const ProxyTexture::Lift& wave = wave_;
    const double below = crest - wave.height;  // the crests
    const double depth = distance - below;
    state_.in_contact = depth > proxy_touch && distance > proxy_touch;
    state_.sticks = false;
    if (state_.in_contact && settings.static_friction > 0.0) {
        const Vec3 lag = before - smooth - state_.normal * glm::dot(before - smooth, state_.normal);
        const double behind = glm::length(lag);
        const double kept = held_back(behind, depth);
        const Vec3 back = behind > 0.0 ? lag * (kept / behind) : lag;
        // Back along the plane, then project to the surface again.
        const Vec3 held = smooth + back;
        smooth = lead(lead(smooth, held + state_.normal * proxy_touch, surfaces), held - state_.normal * proxy_touch,
                      surfaces);
    }
    at_ = smooth;
    state_.proxy = state_.in_contact ? smooth - state_.normal * below : goal;
    state_.force = Vec3(0.0);
    if (!state_.in_contact) {
        friction_ = unset;
        state_.normal = Vec3(0.0);
        return state_;
    }
    // Spring and waves together stay within the limit, each by a law of its own, so that the spring keeps its energy.
    const double most = settings.max_force / (1.0 + (crest > 0.0 ? texture.max_slope() : 0.0));
    Vec3 force = settings.stiffness * (state_.proxy - goal);
    const double size = glm::length(force);
    if (size > most) force *= most / size;
    force -= wave.slope * std::min(settings.stiffness * depth, most);
    if (is_finite(force)) state_.force = force;
    return state_;
}

}  // namespace tactus::coupling
