// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/burr.hpp"

#include "dsp/saw/hand_limits.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace tactus::saw {

namespace {

constexpr int most_moves = 12;
constexpr std::size_t probes = 28;

/// The 26 directions of a cube's faces, edges and corners.
const std::array<Vec3, 26>& cube_directions() {
    static const std::array<Vec3, 26> all = [] {
        std::array<Vec3, 26> made;
        std::size_t n = 0;
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z)
                    if (x != 0 || y != 0 || z != 0) made[n++] = glm::normalize(Vec3(x, y, z));
        return made;
    }();
    return all;
}

}  // namespace

/// Directions in which the ball touches bone, and the free distance otherwise.
struct Burr::Touch {
    std::array<Vec3, probes> towards;
    std::size_t count = 0;
    double density = 0.0, clear = 1.0;
};

Burr::Touch Burr::touch(const volume::BoneSnapshot& bone, const Vec3& lag, double ahead) const noexcept {
    Touch touch;
    std::array<Vec3, probes> looks;
    std::size_t count = 0;
    for (const Vec3& direction : cube_directions()) looks[count++] = direction;
    looks[count++] = glm::normalize(lag);
    const Vec3 slope = bone.sample(at_).gradient;
    if (const double length = glm::length(slope); length > 0.1) looks[count++] = -slope / length;
    double sum = 0.0;
    for (std::size_t n = 0; n < count; ++n) {
        const Vec3 there = at_ + looks[n] * (shape_.radius + ahead);
        const double d = bone.value(there);
        touch.clear = std::min(touch.clear, d + ahead);
        if (d > -0.5 * ahead) continue;
        const double density = bone.density(there);
        if (!(density >= 1.0)) continue;  // bone without density does not resist, as for the teeth of a saw
        touch.towards[touch.count++] = looks[n];
        const double weight = std::max(glm::dot(looks[n], lag), 0.0);
        touch.density += weight * density;
        sum += weight;
    }
    touch.density = sum > 0.0 ? touch.density / sum : 0.0;
    return touch;
}

/// As far as bone allows; returns the density of the bone that stops it, 0: none.
double Burr::follow(const volume::BoneSnapshot& bone, bool running) noexcept {
    const Vec3& spacing = bone.layout().spacing;
    const double voxel = std::max({spacing.x, spacing.y, spacing.z, 1e-6}), ahead = 0.25 * voxel;
    double density = 0.0;
    for (int move = 0; move < most_moves; ++move) {
        const Vec3 lag = target_ - at_;
        const double distance = glm::length(lag);
        if (distance < 1e-9) return 0.0;
        if (bone.value(at_) > shape_.radius + distance + voxel) {
            at_ = target_;
            return 0.0;
        }
        const Touch now = touch(bone, lag, ahead);
        Vec3 way = lag;
        for (int pass = 0; pass < 3; ++pass)
            for (std::size_t n = 0; n < now.count; ++n)
                way -= now.towards[n] * std::max(glm::dot(way, now.towards[n]), 0.0);
        const bool blocked = glm::dot(way - lag, way - lag) > 1e-18;
        density = blocked ? now.density : 0.0;
        const double length = glm::length(way);
        const double held = blocked && !running ? dry_friction * glm::length(lag - way) : 0.0;
        if (length - held < 1e-9) return density;
        const double step = std::min({length - held, blocked ? 0.5 * voxel : std::max(now.clear, 0.25 * voxel), 1e-3});
        const Vec3 next = at_ + way * (step / length);
        const Vec3 left = target_ - next;
        if (glm::dot(left, left) >= distance * distance) return density;
        at_ = next;
    }
    return density;
}

BurrContact Burr::step(const volume::BoneSnapshot& bone, const Pose& pose, bool running, double rate, double dt,
                       const CuttingLaw& law) noexcept {
    BurrContact contact;
    fresh_ = false;
    if (!is_valid(pose) || glm::length(pose.position) > 1e3 || !(dt > 0.0)) {
        seated_ = false;
        return contact;
    }
    const bool jumped = glm::length(pose.position - target_) > std::max(fastest_hand * dt, 0.001);
    target_ = pose.position;
    if (!seated_ || jumped || glm::length(target_ - at_) > most_lag) {
        at_ = target_;
        seated_ = fresh_ = bone.value(at_) >= shape_.radius;
        return contact;
    }
    const double density = follow(bone, running);
    Vec3 lag = target_ - at_;
    double distance = glm::length(lag);
    if (!(distance > 1e-12)) return contact;
    if (running && rate > 0.0 && density >= 1.0) {
        const double scale = law.reference_density / density, stiff = stiffness_ * scale;
        const double u = left_after_cut(law, distance, shape_.flutes * rate * dt,
                                        [&](double stretch) { return std::pair{stiff * stretch, stiff}; });
        contact.feed = (distance - u) / dt;
        at_ += lag * ((distance - u) / distance);
        lag = target_ - at_;
        distance = u;
        contact.along = law.along(stiffness_ * u * scale) / scale;
    }
    contact.wrench.force = lag * -stiffness_;
    contact.wrench.torque = glm::cross(at_ - pose.position, contact.wrench.force);
    contact.load = stiffness_ * distance;
    contact.lag = distance;
    contact.touches = true;
    return contact;
}

void Burr::fill(carve::CutFront& front, const Pose& pose, bool running) const noexcept {
    front.pose = pose;
    front.kerf = 2.0 * shape_.radius;
    front.pitch = shape_.radius;
    front.count = 2;
    front.running = running ? 1 : 0;
    front.seated = seated_ ? 3u : 0u;
    front.fresh = fresh_ ? 3u : 0u;
    front.place(0, at_);
    front.place(1, at_);
}

}  // namespace tactus::saw
