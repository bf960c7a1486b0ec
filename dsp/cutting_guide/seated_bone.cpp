// SPDX-License-Identifier: Apache-2.0
#include "dsp/cutting_guide/seated_bone.hpp"

#include "dsp/core/constants.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tactus::cutting_guide {

namespace {

constexpr double nowhere = -std::numeric_limits<double>::infinity();

}  // namespace

SeatedBone::SeatedBone(const geometry::TriangleSurface& bone, const geometry::TriangleTree& tree, const Vec3& low,
                       const Vec3& high, double spacing, double cap, const RunJobs& run) {
    grid_.origin = low;
    grid_.spacing = Vec3(spacing);
    for (int axis = 0; axis < 3; ++axis)
        grid_.size[static_cast<std::size_t>(axis)] =
            std::max(2, static_cast<int>(std::ceil((high[axis] - low[axis]) / spacing)) + 1);
    grid_.values.assign(grid_.count(), static_cast<float>(cap));
    top_.assign(static_cast<std::size_t>(grid_.size[0]) * static_cast<std::size_t>(grid_.size[1]), nowhere);
    raise(bone);
    run(grid_.size[1], [&](int j) {
        double at_top = infinity;  // distance of the highest sample of the column before
        for (int i = 0; i < grid_.size[0]; ++i) {
            const double top_here = top_[column(i, j)];
            double least = cap, bound = at_top + 1.001 * spacing;
            at_top = infinity;
            for (int k = grid_.size[2] - 1; k >= 0; --k) {
                // Two samples below the surface are enough to find its place between samples.
                const Vec3 p = grid_.position(i, j, k);
                if (p.z < top_here - 2.0 * spacing) {
                    least = std::min(least, -spacing);
                } else {
                    // The distance of a sample beside bounds that of this one, and shortens the search.
                    const double away = tree.nearest(p, bound).distance;
                    if (k == grid_.size[2] - 1) at_top = away;
                    bound = away + 1.001 * spacing;
                    least = std::min(least, p.z < top_here ? -away : away);
                    // None of these samples can come nearer than the cap.
                    for (int skip = static_cast<int>((away - cap) / spacing); skip > 0 && k > 0; --skip)
                        grid_.at(i, j, k--) = static_cast<float>(least), bound += 1.001 * spacing;
                }
                grid_.at(i, j, k) = static_cast<float>(least);
            }
        }
    });
}

// Each triangle raises the columns that it covers.
void SeatedBone::raise(const geometry::TriangleSurface& bone) {
    const double h = grid_.spacing.x;
    for (const auto& t : bone.triangles) {
        Vec3 c[3];
        for (std::size_t n = 0; n < 3; ++n)
            c[n] = (bone.vertices[static_cast<std::size_t>(t[n])] - grid_.origin) / Vec3(h, h, 1.0);
        const double area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[1].y - c[0].y) * (c[2].x - c[0].x);
        if (area == 0.0) continue;
        const auto range = [&](int axis) {
            const double low = std::min({c[0][axis], c[1][axis], c[2][axis]}),
                         high = std::max({c[0][axis], c[1][axis], c[2][axis]});
            const int last = grid_.size[static_cast<std::size_t>(axis)] - 1;
            return std::array{static_cast<int>(std::clamp(std::ceil(low), 0.0, last + 1.0)),
                              static_cast<int>(std::clamp(std::floor(high), -1.0, static_cast<double>(last)))};
        };
        const auto [i0, i1] = range(0);
        const auto [j0, j1] = range(1);
        for (int j = j0; j <= j1; ++j)
            for (int i = i0; i <= i1; ++i) {
                const double u = ((i - c[0].x) * (c[2].y - c[0].y) - (j - c[0].y) * (c[2].x - c[0].x)) / area,
                             v = ((c[1].x - c[0].x) * (j - c[0].y) - (c[1].y - c[0].y) * (i - c[0].x)) / area;
                if (u < -1e-9 || v < -1e-9 || u + v > 1.0 + 1e-9) continue;
                double& top_here = top_[column(i, j)];
                top_here = std::max(top_here, grid_.origin.z + c[0].z + u * (c[1].z - c[0].z) + v * (c[2].z - c[0].z));
            }
    }
}

double SeatedBone::value(const Vec3& p) const noexcept {
    Vec3 at = (p - grid_.origin) / grid_.spacing;
    std::array<int, 3> n{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double inside = std::clamp(at[axis], 0.0, grid_.size[a] - 1.0);
        at[axis] = inside;
        n[a] = std::min(static_cast<int>(inside), grid_.size[a] - 2);
        at[axis] -= n[a];
    }
    double sum = 0.0;
    for (int c = 0; c < 8; ++c) {
        const int x = c & 1, y = c >> 1 & 1, z = c >> 2;
        sum += static_cast<double>(grid_.at(n[0] + x, n[1] + y, n[2] + z)) * (x ? at.x : 1.0 - at.x) *
               (y ? at.y : 1.0 - at.y) * (z ? at.z : 1.0 - at.z);
    }
    return sum;
}

Vec3 SeatedBone::gradient(const Vec3& p) const noexcept {
    const double h = 0.5 * grid_.spacing.x;
    Vec3 g(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 step(0.0);
        step[axis] = h;
        g[axis] = value(p + step) - value(p - step);
    }
    const double length = glm::length(g);
    return length > 1e-3 * h ? g / length : Vec3(0.0, 0.0, 1.0);
}

double SeatedBone::top(double x, double y) const noexcept {
    const int i = static_cast<int>(std::lround((x - grid_.origin.x) / grid_.spacing.x)),
              j = static_cast<int>(std::lround((y - grid_.origin.y) / grid_.spacing.y));
    if (i < 0 || j < 0 || i >= grid_.size[0] || j >= grid_.size[1]) return nowhere;
    return top_[column(i, j)];
}

double SeatedBone::top_within(const Vec3& low, const Vec3& high) const noexcept {
    double most = nowhere;
    for (double y = low.y; y <= high.y; y += 0.5 * grid_.spacing.y)
        for (double x = low.x; x <= high.x; x += 0.5 * grid_.spacing.x) most = std::max(most, top(x, y));
    return most;
}

}  // namespace tactus::cutting_guide
