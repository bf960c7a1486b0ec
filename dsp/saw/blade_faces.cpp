// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/blade_faces.hpp"

#include "dsp/saw/hand_limits.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::saw {

namespace {

constexpr double deepest_row = 5e-3;  // m behind the teeth: a long blade is guided near them
constexpr int most_steps = 10;

}  // namespace

BladeFaces::BladeFaces(const SawShape& shape, double stiffness) {
    for (std::size_t n = 0; n < row; ++n) {
        const double x = shape.length * (static_cast<double>(n) / (row - 1) - 0.5);
        for (std::size_t side = 0; side < 2; ++side) {
            FacePoint& p = points_[n + side * row];
            p.local = Vec3(x, -std::min(0.5 * shape.height, deepest_row), (side == 0 ? 0.5 : -0.5) * shape.thickness);
            const double blade = lateral_stiffness(shape, p.local);
            p.bending = blade / (blade + stiffness);
        }
    }
}

double BladeFaces::square(const FacePoint& p) const noexcept {
    const Vec3 lag = p.target - p.at;
    const double across = glm::dot(lag, axes_[2]);
    return glm::dot(lag, lag) - (1.0 - p.bending) * across * across;
}

void BladeFaces::forget() noexcept {
    for (FacePoint& p : points_) p.seated = false;
}

void BladeFaces::follow(const volume::BoneSnapshot& bone, const Pose& pose, bool running, double dt) noexcept {
    axes_ = Mat3(pose.rotate({1, 0, 0}), pose.rotate({0, 1, 0}), pose.rotate({0, 0, 1}));
    const Vec3& spacing = bone.layout().spacing;
    const double voxel = std::max({spacing.x, spacing.y, spacing.z, 1e-6});
    const double jump = std::max(fastest_hand * dt, 0.001);
    for (FacePoint& p : points_) {
        const Vec3 to = pose.position + axes_ * p.local;
        const bool jumped = glm::length(to - p.target) > jump;
        p.target = to;
        const Vec3 lag = to - p.at;
        const double distance = glm::length(lag);
        if (!p.seated || jumped || distance > most_lag) {
            p.at = to;
            p.seated = bone.value(to) >= 0.0;
        } else if (bone.value(p.at) > distance) {
            p.at = to;
        } else {
            slide(bone, p, voxel, running);
            // Bone does not hold a blade back: what would hook in on the way out lets go.
            const double back = glm::dot(p.target - p.at, axes_[1]);
            if (back < 0.0) p.at += axes_[1] * back;
        }
    }
}

void BladeFaces::slide(const volume::BoneSnapshot& bone, FacePoint& p, double voxel, bool running) const noexcept {
    const double skin = 0.01 * voxel;
    for (int move = 0; move < most_steps; ++move) {
        const Vec3 lag = p.target - p.at;
        const double distance = glm::length(lag);
        if (distance < 1e-9) return;
        const volume::Sample here = bone.sample(p.at);
        const double slope = glm::length(here.gradient);
        if (here.value > skin || !(slope > 0.1)) {
            p.at += lag * std::min(1.0, std::max(here.value, 0.1 * voxel) / distance);
            continue;
        }
        const Vec3 normal = here.gradient / slope;
        const double inward = glm::dot(lag, normal);
        if (inward >= 0.0) {  // out of the bone
            p.at += lag * std::min(1.0, std::max(here.value, 0.25 * voxel) / distance);
            continue;
        }
        const Vec3 along = lag - normal * inward;
        const double way = glm::length(along), held = running ? 0.0 : dry_friction * -inward;
        if (way - held < 1e-9) return;
        FacePoint next = p;
        next.at += along * (std::min(way - held, 0.5 * voxel) / way);
        // Where the surface rises, up to it.
        const double low = std::min(here.value, skin);
        const double sunk = low - bone.value(next.at);
        if (sunk > 0.0) next.at += normal * sunk;
        if (bone.value(next.at) < low - 1e-9 || square(next) >= square(p)) return;
        p.at = next.at;
    }
}

}  // namespace tactus::saw
