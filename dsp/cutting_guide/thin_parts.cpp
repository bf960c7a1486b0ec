// SPDX-License-Identifier: Apache-2.0
#include "dsp/cutting_guide/thin_parts.hpp"

#include "dsp/core/constants.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace tactus::cutting_guide {

namespace {

// m: of the grid of the opening. A field of distances at 0.95 mm is off by spacing² / 8 / 0.95 mm = 0.01 mm between
// samples.
constexpr double spacing = 0.25 * mm;

volume::Grid grid_around(std::span<const ThinWall> thin, double margin) {
    Vec3 low(infinity), high(-infinity);
    for (const ThinWall& wall : thin) low = glm::min(low, wall.at), high = glm::max(high, wall.at);
    volume::Grid grid;
    grid.origin = low - margin;
    grid.spacing = Vec3(spacing);
    for (int axis = 0; axis < 3; ++axis)
        grid.size[static_cast<std::size_t>(axis)] =
            static_cast<int>(std::ceil((high[axis] - low[axis] + 2.0 * margin) / spacing)) + 1;
    return grid;
}

/// Lowers samples to their distance from the nearest of `points`, within `reach` of them.
void lower_to_distance(volume::Grid& grid, std::span<const Vec3> points, double reach) {
    for (const Vec3& p : points) {
        std::array<int, 3> first{}, last{};
        for (int axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<std::size_t>(axis);
            const double at = (p[axis] - grid.origin[axis]) / grid.spacing.x, cells = reach / grid.spacing.x;
            first[a] = std::max(0, static_cast<int>(std::ceil(at - cells)));
            last[a] = std::min(grid.size[a] - 1, static_cast<int>(std::floor(at + cells)));
        }
        for (int k = first[2]; k <= last[2]; ++k)
            for (int j = first[1]; j <= last[1]; ++j)
                for (int i = first[0]; i <= last[0]; ++i) {
                    float& here = grid.at(i, j, k);
                    here = std::min(here, static_cast<float>(glm::length(grid.position(i, j, k) - p)));
                }
    }
}

}  // namespace

Body thin_parts(const GuideSolid& solid, const geometry::TriangleTree& surface, const Walls& walls, double limit,
                const RunJobs& run) {
    const double radius = 0.5 * limit, near = radius + spacing, kept = radius + 0.75 * wall_slack;
    const double reach = kept + 2.0 * spacing;
    volume::Grid from_thin = grid_around(walls.thin, near + 3.0 * spacing);
    from_thin.values.assign(from_thin.count(), static_cast<float>(near + 2.0 * spacing));
    std::vector<Vec3> thin;
    for (const ThinWall& wall : walls.thin) thin.push_back(wall.at);
    lower_to_distance(from_thin, thin, near + 2.0 * spacing);
    volume::Grid from_balls = from_thin;
    from_balls.values.assign(from_balls.count(), static_cast<float>(reach));
    lower_to_distance(from_balls, walls.balls, reach);
    run(from_balls.size[2], [&](int k) {
        for (int j = 0; j < from_balls.size[1]; ++j)
            for (int i = 0; i < from_balls.size[0]; ++i) {
                float& here = from_balls.at(i, j, k);
                const float aside = from_thin.at(i, j, k) - static_cast<float>(near);
                // Deeper than a ball is wide no triangle is as near as the middles of balls are.
                const Vec3 p = from_balls.position(i, j, k);
                const bool is_deep = aside < 0.0f && here > static_cast<float>(radius) && solid.value(p) < 0.0 &&
                                     !(surface.nearest(p, radius).distance < radius);
                here = std::max(aside, static_cast<float>(kept) - (is_deep ? 0.0f : here));
            }
    });
    Term term{Term::Kind::near};
    term.patch = std::make_shared<const Patch>(Patch{{std::move(from_balls)}, Vec3(0.0), Vec3(0.0)});
    return {std::move(term)};
}

}  // namespace tactus::cutting_guide
