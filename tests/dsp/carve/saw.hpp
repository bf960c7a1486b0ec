// SPDX-License-Identifier: Apache-2.0
// A block of bone, 18 × 12 × 12 mm, its top at y = 0, and a saw that is pressed into it.
#pragma once

#include "tests/dsp/carve/dense_field.hpp"

#include <numbers>

namespace tactus::test {

inline constexpr double voxel = 0.00033;
inline const Vec3 block_low{-0.009, -0.012, -0.006};
inline const Vec3 block_high{0.009, 0.0, 0.006};
inline const Quat downwards = glm::angleAxis(std::numbers::pi, Vec3(1, 0, 0));  // the blade cuts towards -y

inline DenseField block(const Vec3& shift = Vec3(0.0), double density = 1800.0, const Vec3& spacing = Vec3(voxel)) {
    DenseField field;
    field.grid = sampled(Vec3(-0.013, -0.015, -0.009) + shift, Vec3(0.013, 0.004, 0.009) + shift, spacing,
                         [](const Vec3& p) { return box_distance(p, block_low, block_high); });
    field.bone_density = [density](const Vec3&) { return density; };
    return field;
}

/// The centre of the blade's round front, half a kerf behind the teeth, held at `from`, then moved at `velocity` (m/s), a sample each millisecond.
inline std::vector<carve::CarveSample> stroke(const Vec3& from, const Vec3& velocity, double seconds,
                                              const Quat& orientation = downwards, bool running = true) {
    std::vector<carve::CarveSample> samples;
    const Vec3 teeth = from + orientation * Vec3(0.0, 0.0005, 0.0);
    const int count = static_cast<int>(std::lround(seconds * 1000.0));
    for (int n = 0; n < count; ++n) {
        samples.push_back({Pose{teeth + velocity * (0.001 * n), orientation}, 0.001, 7.0, 228.0, running});
    }
    return samples;
}

/// Feeds the samples in calls of `per_call`; returns the sum.
template <class Carving, class Field>
carve::CarveResult carve_through(Carving& carver, Field& field, std::span<const carve::CarveSample> samples,
                                 std::size_t per_call = 17) {
    carve::CarveResult sum;
    for (std::size_t n = 0; n < samples.size(); n += per_call) {
        const carve::CarveResult part =
            carver.update(field, samples.subspan(n, std::min(per_call, samples.size() - n)));
        sum.removed_m3 += part.removed_m3;
        for (std::size_t c = 0; c < 4; ++c) sum.removed_by_density[c] += part.removed_by_density[c];
        sum.dirty_bricks = part.dirty_bricks;
        sum.budget_hit |= part.budget_hit;
    }
    return sum;
}

/// How far the middle of the edge has come below the top of the block, m; its front is half a kerf further.
inline double depth(const carve::CarveCore& carver) {
    const auto nodes = carver.edge().nodes();
    return -nodes[nodes.size() / 2].at.y;
}

/// Volume of a cut through the block along x: a slot of the kerf's width with a round floor, m³.
inline double slot(double depth_of_edge, double kerf = 0.001) {
    return 0.018 * (depth_of_edge * kerf + std::numbers::pi * kerf * kerf / 8.0);
}

}  // namespace tactus::test
