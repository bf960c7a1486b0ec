// SPDX-License-Identifier: Apache-2.0
#include "dsp/cutting_guide/thin_parts.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

namespace tactus::cutting_guide {

namespace {

volume::Grid grid_around(std::span<const ThinWall> thin, double margin, double spacing) {
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

/// Distance from the nearest middle of a thin wall, m, at most `cap`.
volume::Grid distance_from(std::span<const ThinWall> thin, volume::Grid grid, double cap) {
    grid.values.assign(grid.count(), static_cast<float>(cap));
    for (const ThinWall& wall : thin) {
        std::array<int, 3> first{}, last{};
        for (int axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<std::size_t>(axis);
            const double at = (wall.at[axis] - grid.origin[axis]) / grid.spacing.x, reach = cap / grid.spacing.x;
            first[a] = std::max(0, static_cast<int>(std::ceil(at - reach)));
            last[a] = std::min(grid.size[a] - 1, static_cast<int>(std::floor(at + reach)));
        }
        for (int k = first[2]; k <= last[2]; ++k)
            for (int j = first[1]; j <= last[1]; ++j)
                for (int i = first[0]; i <= last[0]; ++i) {
                    float& here = grid.at(i, j, k);
                    here = std::min(here, static_cast<float>(glm::length(grid.position(i, j, k) - wall.at)));
                }
    }
    return grid;
}

}  // namespace

Body thin_parts(const GuideSolid& solid, const geometry::TriangleTree& surface, std::span<const ThinWall> thin,
                double thickness, double spacing, const RunJobs& run) {
    const double radius = 0.5 * thickness, near = radius + spacing, cap = radius + 2.0 * spacing;
    volume::Grid grid = grid_around(thin, near + 2.0 * radius + 3.0 * spacing, spacing);
    // Depth below the surface, less the radius: negative where a ball fits.
    grid.values.assign(grid.count(), static_cast<float>(cap));
    run(grid.size[2], [&](int k) {
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                const Vec3 p = grid.position(i, j, k);
                const double value = solid.value(p);
                if (!(value < 0.0)) continue;
                // A field of bodies is at most as deep as the surface is far.
                const double depth = -value > cap ? cap : std::min(cap, surface.nearest(p, cap).distance);
                grid.at(i, j, k) = static_cast<float>(radius - depth);
            }
    });
    const geometry::TriangleTree balls(geometry::iso_surface(grid, 0.0f, false));
    const volume::Grid from_thin = distance_from(thin, grid, near + 2.0 * spacing);
    run(grid.size[2], [&](int k) {
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                float& here = grid.at(i, j, k);
                const float aside = from_thin.at(i, j, k) - static_cast<float>(near);
                const double away = here < 0.0f || aside >= 0.0f
                                        ? 0.0
                                        : std::min(cap, balls.nearest(grid.position(i, j, k), cap).distance);
                here = std::max(aside, static_cast<float>(radius - away));
            }
    });
    Term term{Term::Kind::near};
    term.patch = std::make_shared<const Patch>(Patch{{std::move(grid)}, Vec3(0.0), Vec3(0.0)});
    return {std::move(term)};
}

}  // namespace tactus::cutting_guide
