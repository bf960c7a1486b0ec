// SPDX-License-Identifier: Apache-2.0
#include "dsp/cutting_guide/seated_bone.hpp"

#include "dsp/core/constants.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace tactus::cutting_guide {

namespace {

constexpr double nowhere = -std::numeric_limits<double>::infinity();

/// The closest point of a sample. For the next sample it is a point on the surface that is nearly the closest, which
/// bounds the search better than the distance of the samples from each other does.
struct Closest {
    Vec3 point{0.0};
    bool is_known = false;

    /// The distance from `p`, if it is less than `within`; else infinite.
    double find(const geometry::TriangleTree& tree, const Vec3& p, double within) {
        const auto near =
            tree.nearest(p, is_known ? std::min(within, 1.000001 * glm::length(p - point) + 1e-12) : within);
        is_known = std::isfinite(near.distance);
        if (is_known) point = near.point;
        return near.distance;
    }
};

/// Of the parts that share vertices, the one with the triangle nearest to `at`.
void keep_part_near(geometry::TriangleSurface& surface, const Vec3& at) {
    std::vector<int> root(surface.vertices.size());
    std::iota(root.begin(), root.end(), 0);
    const auto root_of = [&](int v) {
        while (root[static_cast<std::size_t>(v)] != v)
            v = root[static_cast<std::size_t>(v)] = root[static_cast<std::size_t>(root[static_cast<std::size_t>(v)])];
        return v;
    };
    int nearest = -1;
    double least = infinity;
    for (const auto& t : surface.triangles) {
        const int a = root_of(t[0]);
        root[static_cast<std::size_t>(root_of(t[1]))] = a, root[static_cast<std::size_t>(root_of(t[2]))] = a;
        const Vec3 r = surface.vertices[static_cast<std::size_t>(t[0])] - at;
        if (const double away = glm::dot(r, r); away < least) least = away, nearest = t[0];
    }
    if (nearest < 0) return;
    const int kept = root_of(nearest);
    std::erase_if(surface.triangles, [&](const auto& t) { return root_of(t[0]) != kept; });
}

}  // namespace

SeatedBone::SeatedBone(const geometry::TriangleSurface& bone, const geometry::TriangleTree& tree, const Vec3& low,
                       const Vec3& high, double spacing, double cap, const RunJobs& run)
    : cap_(cap) {
    volume::Grid& grid = field_.grid;
    grid.origin = spacing * glm::floor(low / spacing);
    grid.spacing = Vec3(spacing);
    for (int axis = 0; axis < 3; ++axis)
        grid.size[static_cast<std::size_t>(axis)] =
            std::max(2, static_cast<int>(std::ceil((high[axis] - grid.origin[axis]) / spacing)) + 1);
    grid.values.assign(grid.count(), static_cast<float>(cap));
    top_.assign(static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1]), nowhere);
    raise(bone);
    run(grid.size[1], [&](int j) {
        Closest at_top;  // of the highest sample of the column before
        for (int i = 0; i < grid.size[0]; ++i) {
            const double top_here = top_[column(i, j)];
            double least = cap;
            Closest closest = std::exchange(at_top, {});
            for (int k = grid.size[2] - 1; k >= 0; --k) {
                // Two samples below the surface are enough to find its place between samples.
                const Vec3 p = grid.position(i, j, k);
                if (p.z < top_here - 2.0 * spacing) {
                    least = std::min(least, -spacing);
                } else {
                    const double away = closest.find(tree, p, infinity);
                    if (k == grid.size[2] - 1) at_top = closest;
                    least = std::min(least, p.z < top_here ? -away : away);
                    // None of these samples can come nearer than the cap.
                    for (int skip = static_cast<int>((away - cap) / spacing); skip > 0 && k > 0; --skip)
                        grid.at(i, j, k--) = static_cast<float>(least);
                }
                grid.at(i, j, k) = static_cast<float>(least);
            }
        }
    });
}

// Each triangle raises the columns that it covers.
void SeatedBone::raise(const geometry::TriangleSurface& bone) {
    const volume::Grid& grid = field_.grid;
    const double h = grid.spacing.x;
    for (const auto& t : bone.triangles) {
        Vec3 c[3];
        for (std::size_t n = 0; n < 3; ++n)
            c[n] = (bone.vertices[static_cast<std::size_t>(t[n])] - grid.origin) / Vec3(h, h, 1.0);
        const double area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[1].y - c[0].y) * (c[2].x - c[0].x);
        if (area == 0.0) continue;
        const auto range = [&](int axis) {
            const double low = std::min({c[0][axis], c[1][axis], c[2][axis]}),
                         high = std::max({c[0][axis], c[1][axis], c[2][axis]});
            const int last = grid.size[static_cast<std::size_t>(axis)] - 1;
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
                top_here = std::max(top_here, grid.origin.z + c[0].z + u * (c[1].z - c[0].z) + v * (c[2].z - c[0].z));
            }
    }
}

Patch SeatedBone::patch_of(const std::function<bool(const Vec3&, const Vec3&)>& belongs, const Vec3& at,
                           const RunJobs& run) const {
    const volume::Grid& grid = field_.grid;
    const double spacing = grid.spacing.x;
    geometry::TriangleSurface surface = geometry::iso_surface(grid, 0.0f, false);
    const auto corner = [&](const std::array<int, 3>& t, std::size_t c) {
        return surface.vertices[static_cast<std::size_t>(t[c])];
    };
    std::erase_if(surface.triangles, [&](const std::array<int, 3>& t) {
        const Vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2), normal = glm::cross(b - a, c - a);
        return normal == Vec3(0.0) || !belongs((a + b + c) / 3.0, glm::normalize(normal));
    });
    keep_part_near(surface, at);
    const geometry::TriangleTree tree(surface);
    Patch found{{grid}, at, at};
    for (const auto& t : surface.triangles)
        for (std::size_t c = 0; c < 3; ++c)
            found.low = glm::min(found.low, corner(t, c)), found.high = glm::max(found.high, corner(t, c));
    run(grid.size[1], [&](int j) {
        const auto is_deep = [&](int i, int row, int k) {
            return i < 0 || row < 0 || i >= grid.size[0] || row >= grid.size[1] ||
                   grid.at(i, row, k) <= static_cast<float>(-spacing);
        };
        for (int k = 0; k < grid.size[2]; ++k) {
            Closest closest;
            for (int i = 0; i < grid.size[0]; ++i) {
                const bool is_needed = grid.at(i, j, k) < static_cast<float>(cap_) &&
                                       !(is_deep(i, j, k) && is_deep(i - 1, j, k) && is_deep(i + 1, j, k) &&
                                         is_deep(i, j - 1, k) && is_deep(i, j + 1, k));
                const double away = is_needed ? std::min(cap_, closest.find(tree, grid.position(i, j, k), cap_)) : cap_;
                found.distance.grid.at(i, j, k) = static_cast<float>(away);
            }
        }
    });
    return found;
}

std::shared_ptr<const Patch> SeatedBone::distance_from(const geometry::TriangleTree& tree, double cap,
                                                       const RunJobs& run) const {
    auto made = std::make_shared<Patch>(Patch{{field_.grid}, Vec3(0.0), Vec3(0.0)});
    volume::Grid& grid = made->distance.grid;
    run(grid.size[2], [&](int k) {
        for (int j = 0; j < grid.size[1]; ++j) {
            Closest closest;
            for (int i = 0; i < grid.size[0]; ++i)
                grid.at(i, j, k) = static_cast<float>(std::min(cap, closest.find(tree, grid.position(i, j, k), cap)));
        }
    });
    return made;
}

double DistanceField::value(const Vec3& p) const noexcept {
    Vec3 at = (p - grid.origin) / grid.spacing;
    std::array<int, 3> n{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double inside = std::clamp(at[axis], 0.0, grid.size[a] - 1.0);
        at[axis] = inside;
        n[a] = std::min(static_cast<int>(inside), grid.size[a] - 2);
        at[axis] -= n[a];
    }
    double sum = 0.0;
    for (int c = 0; c < 8; ++c) {
        const int x = c & 1, y = c >> 1 & 1, z = c >> 2;
        sum += static_cast<double>(grid.at(n[0] + x, n[1] + y, n[2] + z)) * (x ? at.x : 1.0 - at.x) *
               (y ? at.y : 1.0 - at.y) * (z ? at.z : 1.0 - at.z);
    }
    return sum;
}

Vec3 DistanceField::gradient(const Vec3& p) const noexcept {
    const double h = 0.5 * grid.spacing.x;
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
    const int i = static_cast<int>(std::lround((x - field_.grid.origin.x) / field_.grid.spacing.x)),
              j = static_cast<int>(std::lround((y - field_.grid.origin.y) / field_.grid.spacing.y));
    if (i < 0 || j < 0 || i >= field_.grid.size[0] || j >= field_.grid.size[1]) return nowhere;
    return top_[column(i, j)];
}

double SeatedBone::top_within(const Vec3& low, const Vec3& high) const noexcept {
    double most = nowhere;
    for (double y = low.y; y <= high.y; y += 0.5 * field_.grid.spacing.y)
        for (double x = low.x; x <= high.x; x += 0.5 * field_.grid.spacing.x) most = std::max(most, top(x, y));
    return most;
}

}  // namespace tactus::cutting_guide
