// SPDX-License-Identifier: Apache-2.0
#include "assets/library/mandible.hpp"

#include "assets/bone/from_hu.hpp"
#include "assets/library/smooth_step.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "dsp/volume/iso_distance.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::library {

namespace {

constexpr double jaw_voxel = 0.3 * mm;
constexpr double half_length = 27.2 * mm;   // along the arch
constexpr double curvature = 1.0 / 0.055;   // of the arch at its middle, 1/m
constexpr double half_width = 5.7 * mm, half_height = 13.7 * mm;  // the surface lies 0.3 mm outside
constexpr float soft_tissue = 40.0f, cortical = 1520.0f, cancellous = 290.0f, canal = 190.0f;

// Value noise: random values at integers, interpolated smoothly; in [-1, 1].
double value_noise(const Random& random, const Vec3& at) {
    const Vec3 cell = glm::floor(at);
    const Vec3 t = at - cell;
    double sum = 0.0;
    for (int c = 0; c < 8; ++c) {
        const int x = c & 1, y = c >> 1 & 1, z = c >> 2;
        const auto i = static_cast<std::uint64_t>(static_cast<std::int64_t>(cell.x) + x + 4096);
        const auto j = static_cast<std::uint64_t>(static_cast<std::int64_t>(cell.y) + y + 4096);
        const auto k = static_cast<std::uint64_t>(static_cast<std::int64_t>(cell.z) + z + 4096);
        const double weight =
            smooth_step(x ? t.x : 1.0 - t.x) * smooth_step(y ? t.y : 1.0 - t.y) * smooth_step(z ? t.z : 1.0 - t.z);
        sum += weight * (2.0 * random.uniform(i << 40 | j << 20 | k) - 1.0);
    }
    return sum;
}

// Curvilinear coordinates of a point, m: along (s), across (u) and up (v) the body.
Vec3 arch_coordinates(const Vec3& p) {
    // Nearest point of the parabola y = curvature x² / 2, by Newton steps from below the point.
    double x = p.x;
    for (int step = 0; step < 4; ++step) {
        const double y = 0.5 * curvature * x * x, slope = curvature * x;
        const double f = (x - p.x) + (y - p.y) * slope;
        const double df = 1.0 + slope * slope + std::max(0.0, (y - p.y) * curvature);
        x -= f / df;
    }
    const double slope = curvature * x, stretch = std::sqrt(1.0 + slope * slope);
    const double across = ((p.y - 0.5 * curvature * x * x) - slope * (p.x - x)) / stretch;
    const double along = 0.5 * (x * stretch + std::asinh(slope) / curvature);
    return {along, across, p.z};
}

/// Distance to the wall of the mandibular canal, m, negative inside; curvilinear coordinates.
double bore_distance(const Vec3& q) { return glm::length(Vec3(q.y + 0.6 * mm, q.z + 5.0 * mm, 0.0)) - 1.5 * mm; }

float hu_at(const Vec3& p, const Random& random) {
    const Vec3 q = arch_coordinates(p);
    // Egg: wider below than above.
    const double width = half_width * (1.0 - 0.18 * q.z / half_height);
    const double a = q.y / width, b = q.z / half_height;
    const double r = std::sqrt(a * a + b * b);
    const double steep = std::sqrt(a * a / (width * width) + b * b / (half_height * half_height));
    const double side = r > 1e-9 ? (r - 1.0) * r / steep : -half_width;  // first-order distance to the egg
    const double end = std::abs(q.x) - half_length;
    const double outside = std::max(side, end);
    const double cortex = (2.5 - 0.35 * b + 0.15 * std::sin(q.x / (9.0 * mm))) * mm;
    const double texture = 0.7 * value_noise(random, p / (1.1 * mm)) + 0.3 * value_noise(random, p / (0.5 * mm));
    double hu = cancellous + 110.0 * texture;
    // The two ends are resection faces: they show the core.
    const double shell = smooth_step((side + cortex) / (0.8 * mm) + 0.5);
    hu += shell * (cortical + 40.0 * std::sin(q.x / (7.0 * mm)) + 25.0 * value_noise(random, p / (4.0 * mm)) - hu);
    const double bore = bore_distance(q);
    const double wall = smooth_step(1.0 - std::abs(bore - 0.4 * mm) / (0.6 * mm));
    hu += wall * std::max(0.0, 900.0 - hu);
    hu += smooth_step(0.5 - bore / (0.4 * mm)) * (canal - hu);
    hu += smooth_step(outside / jaw_voxel + 0.5) * (soft_tissue - hu);
    return static_cast<float>(hu);
}

volume::Grid layout() {
    volume::Grid grid{{178, 84, 104}, {}, Vec3(jaw_voxel), {}};
    grid.origin = Vec3(-0.5 * (grid.size[0] - 1) * jaw_voxel, -8.5 * mm, -0.5 * (grid.size[2] - 1) * jaw_voxel);
    return grid;
}

}  // namespace

volume::Grid mandible_hu() {
    volume::Grid hu = layout();
    hu.values.reserve(hu.count());
    const Random random{2026};
    for (int k = 0; k < hu.size[2]; ++k)
        for (int j = 0; j < hu.size[1]; ++j)
            for (int i = 0; i < hu.size[0]; ++i) hu.values.push_back(hu_at(hu.position(i, j, k), random));
    return volume::smoothed(hu);
}

bone::Bone make_mandible() {
    // The threshold lies below the values of the core, because the open ends show cancellous bone, which must count as
    // bone.
    bone::Bone bone = bone::bone_from_hu(mandible_hu(), {.threshold = 150.0f, .keep = 1, .fill = true}).bone;
    bone.name = "mandible";
    bone.provenance["source"] = "generated by formula: body of a mandible, 55 mm along the arch";
    bone.provenance["hu"] = "simulated";
    return bone;
}

volume::Grid mandible_canal() {
    volume::Grid labels = layout();
    // The layers that hold it.
    constexpr int first = 26, last = 44;
    labels.origin.z += first * jaw_voxel;
    labels.size[2] = last - first + 1;
    labels.values.reserve(labels.count());
    for (int k = 0; k < labels.size[2]; ++k)
        for (int j = 0; j < labels.size[1]; ++j)
            for (int i = 0; i < labels.size[0]; ++i) {
                const Vec3 q = arch_coordinates(labels.position(i, j, k));
                labels.values.push_back(bore_distance(q) < 0.0 && std::abs(q.x) < half_length ? 1.0f : 0.0f);
            }
    return labels;
}

}  // namespace tactus::library
