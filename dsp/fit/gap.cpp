// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/gap.hpp"

#include "dsp/core/stop.hpp"
#include "dsp/core/weighted_quantile.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace tactus::fit {

SurfaceGap gap_between(std::span<const contact::SurfacePoint> points, const Pose& pose, const contact::Voxmap& other,
                       const Pose& other_pose, const GapSettings& settings) {
    const Pose into = other_pose.inverse() * pose;
    SurfaceGap gap;
    gap.distance.assign(points.size(), std::numeric_limits<float>::infinity());
    std::vector<double> values, weights;
    for (std::size_t n = 0; n < points.size(); ++n) {
        if (n % 4096 == 0) leave_if_stopped();
        const volume::Sample here = other.sample(into.apply(points[n].position));
        if (!here.inside) continue;
        if (here.value < 0.0) gap.deepest = std::max(gap.deepest, -here.value);
        if (!(std::abs(here.value) < settings.near)) continue;
        if (!(glm::dot(into.rotate(points[n].normal), here.gradient) < -0.3)) continue;
        gap.distance[n] = static_cast<float>(here.value);
        gap.facing_area += points[n].area;
        if (here.value < settings.contact) gap.contact_area += points[n].area;
        values.push_back(here.value);
        weights.push_back(points[n].area);
    }
    if (values.empty()) return gap;
    gap.median = weighted_quantile(values, weights, 0.5);
    gap.p95 = weighted_quantile(values, weights, 0.95);
    return gap;
}

namespace {

/// Central differences, one-sided at the border; as long as the distance is exact, of length 1.
Vec3 gradient_at(const volume::Grid& grid, int i, int j, int k) {
    const std::array<int, 3> at{i, j, k};
    Vec3 gradient(0.0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::array<int, 3> low = at, high = at;
        low[axis] = std::max(0, at[axis] - 1);
        high[axis] = std::min(grid.size[axis] - 1, at[axis] + 1);
        const double rise = static_cast<double>(grid.at(high[0], high[1], high[2])) -
                            static_cast<double>(grid.at(low[0], low[1], low[2]));
        const auto a = static_cast<int>(axis);
        gradient[a] = rise / (std::max(1, high[axis] - low[axis]) * grid.spacing[a]);
    }
    return gradient;
}

}  // namespace

double overlap_volume(const volume::Grid& first, const Pose& pose, const contact::Voxmap& other,
                      const Pose& other_pose) {
    const Pose into = other_pose.inverse() * pose;
    const double edge = (first.spacing.x + first.spacing.y + first.spacing.z) / 3.0;
    double voxels = 0.0;
    std::size_t n = 0;
    for (int k = 0; k < first.size[2]; ++k) {
        leave_if_stopped();
        for (int j = 0; j < first.size[1]; ++j)
            for (int i = 0; i < first.size[0]; ++i, ++n) {
                const double mine = std::clamp(0.5 - first.values[n] / edge, 0.0, 1.0);
                if (!(mine > 0.0)) continue;
                const volume::Sample there = other.sample(into.apply(first.position(i, j, k)));
                const double its = there.inside ? std::clamp(0.5 - there.value / edge, 0.0, 1.0) : 0.0;
                if (!(its > 0.0)) continue;
                const double least = std::max(0.0, mine + its - 1.0), most = std::min(mine, its);
                if (least == most) {
                    voxels += least;
                    continue;
                }
                const Vec3 a = into.rotate(gradient_at(first, i, j, k)), b = there.gradient;
                const double size = glm::length(a) * glm::length(b);
                const double alike = size > 0.0 ? 0.5 * (1.0 + glm::dot(a, b) / size) : 0.5;
                voxels += least + alike * (most - least);
            }
    }
    return voxels * first.spacing.x * first.spacing.y * first.spacing.z;
}

}  // namespace tactus::fit
