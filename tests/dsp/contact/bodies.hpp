// SPDX-License-Identifier: Apache-2.0
// Bodies with known distances and evenly spread points, for tests of contact.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/shape.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/core/random.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tactus::bodies {

/// Points on a square of the given side in the plane z = 0 that look towards −z: a flat foot that stands on things.
inline std::vector<contact::SurfacePoint> foot_points(int per_side, double side) {
    std::vector<contact::SurfacePoint> points;
    const double step = side / per_side;
    for (int j = 0; j < per_side; ++j)
        for (int i = 0; i < per_side; ++i)
            points.push_back({Vec3((i + 0.5) * step - 0.5 * side, (j + 0.5) * step - 0.5 * side, 0.0),
                              Vec3(0.0, 0.0, -1.0), step * step, contact::surface_label::none});
    return points;
}

inline contact::Voxmap ball(int size, double spacing, double radius) {
    return contact::sample_voxmap(contact::centred_layout(size, spacing),
                                  [ball = contact::Ball{radius}](const Vec3& p) { return ball.distance(p); });
}

/// A ball with waves on it: gradients in every direction. |∇| stays near 1.
inline contact::Voxmap rough_ball(int size, double spacing, double radius) {
    return contact::sample_voxmap(contact::centred_layout(size, spacing), [=](const Vec3& p) {
        return glm::length(p) - radius +
               0.1 * radius * std::sin(4.0 * p.x / radius) * std::cos(3.0 * p.y / radius + p.z / radius);
    });
}

/// Pose `index` of a series: random turn, random place within `reach` of the origin.
inline Pose random_pose(const Random& random, std::uint64_t index, double reach) {
    const auto at = [&](std::uint64_t n) { return random.normal(8 * index + n); };
    Quat q(at(0), at(1), at(2), at(3));
    const auto u = [&](std::uint64_t n) { return 2.0 * random.uniform(8 * index + n) - 1.0; };
    return {reach * Vec3(u(4), u(5), u(6)), glm::normalize(q)};
}

/// The pose after the small motion (v, ω) about `about`, along world axes.
inline Pose moved(const Pose& pose, const Vec3& about, const Vec3& v, const Vec3& w) {
    const double angle = glm::length(w);
    const Quat turn = angle > 0.0 ? glm::angleAxis(angle, w / angle) : Quat(1, 0, 0, 0);
    return {about + v + turn * (pose.position - about), glm::normalize(turn * pose.orientation)};
}

/// True when xᵀKx ≥ 0 for every x, but for rounding: Cholesky's pivots of K + rounding·diag K are all positive.
inline bool never_negative(std::array<double, 36> k, double rounding) {
    for (std::size_t i = 0; i < 6; ++i) k[7 * i] += rounding * std::abs(k[7 * i]) + 1e-12;
    for (std::size_t i = 0; i < 6; ++i) {
        if (!(k[7 * i] > 0.0)) return false;
        for (std::size_t j = i + 1; j < 6; ++j)
            for (std::size_t n = i + 1; n < 6; ++n) k[6 * j + n] -= k[6 * j + i] * k[6 * i + n] / k[7 * i];
    }
    return true;
}

}  // namespace tactus::bodies
