// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/gap.hpp"

#include "dsp/core/weighted_quantile.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace tactus::fit {

SurfaceGap gap_between(std::span<const contact::SurfacePoint> points, const Pose& pose, const contact::Voxmap& other,
                       const Pose& other_pose, const GapSettings& settings) {
    const Pose into = other_pose.inverse() * pose;
    SurfaceGap gap;
    gap.distance.assign(points.size(), std::numeric_limits<float>::infinity());
    std::vector<double> values, weights;
    for (std::size_t n = 0; n < points.size(); ++n) {
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

double overlap_volume(const volume::Grid& first, const Pose& pose, const contact::Voxmap& other,
                      const Pose& other_pose) {
    const Pose into = other_pose.inverse() * pose;
    const double edge = (first.spacing.x + first.spacing.y + first.spacing.z) / 3.0;
    double voxels = 0.0;
    std::size_t n = 0;
    for (int k = 0; k < first.size[2]; ++k)
        for (int j = 0; j < first.size[1]; ++j)
            for (int i = 0; i < first.size[0]; ++i, ++n) {
                const double mine = first.values[n];
                if (!(mine < 0.5 * edge)) continue;
                const volume::Sample there = other.sample(into.apply(first.position(i, j, k)));
                if (!there.inside) continue;
                voxels += std::clamp(0.5 - std::max(mine, there.value) / edge, 0.0, 1.0);
            }
    return voxels * first.spacing.x * first.spacing.y * first.spacing.z;
}

}  // namespace tactus::fit
