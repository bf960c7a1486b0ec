// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/mutual_gap.hpp"

#include "dsp/core/weighted_quantile.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tactus::fit {

MutualGap mutual_gap(const PlacedBone& a, const PlacedBone& b, const GapSettings& settings) {
    MutualGap both;
    std::vector<double> values, weights;
    const auto add = [&](const PlacedBone& mine, const PlacedBone& other) {
        const SurfaceGap gap = gap_between(mine.points, mine.points_pose, *other.map, other.map_pose, settings);
        both.facing += 0.5 * gap.facing_area;
        both.contact += 0.5 * gap.contact_area;
        both.deepest = std::max(both.deepest, gap.deepest);
        for (std::size_t n = 0; n < gap.distance.size(); ++n) {
            if (!std::isfinite(gap.distance[n])) continue;
            values.push_back(static_cast<double>(gap.distance[n]));
            weights.push_back(mine.points[n].area);
        }
    };
    add(a, b);
    add(b, a);
    if (values.empty()) return both;
    both.median = weighted_quantile(values, weights, 0.5);
    both.p95 = weighted_quantile(values, weights, 0.95);
    return both;
}

}  // namespace tactus::fit
