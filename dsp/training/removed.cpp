// SPDX-License-Identifier: Apache-2.0
#include "dsp/training/removed.hpp"

#include "dsp/volume/interpolation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::training {

namespace {

constexpr double outside = 1.0;  // m: distance where there is no grid

double value_at(const volume::Grid& grid, const Vec3& p) noexcept {
    const volume::GridCell cell = volume::find_grid_cell(grid.origin, grid.spacing, grid.size, p);
    if (!cell.inside) return outside;
    const auto row = static_cast<std::size_t>(grid.size[0]);
    return volume::Trilinear(&grid.values[grid.index(cell.i, cell.j, cell.k)], row,
                             row * static_cast<std::size_t>(grid.size[1]))
        .value(cell);
}

/// Share of a voxel of edge `h` that lies within a surface at the signed distance `d`.
double share_inside(double d, double h) { return std::clamp(0.5 - d / h, 0.0, 1.0); }

/// Range of coordinates in the plan that the grid covers.
struct Span {
    double low = 1e9, high = -1e9;
    void add(double v) {
        low = std::min(low, v);
        high = std::max(high, v);
    }
};

struct PlanBox {
    Span along, down;
};

PlanBox box_of_bone(const volume::Grid& grid, const PlannedCut& cut) {
    PlanBox box;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p =
            cut.coordinates(grid.position((corner & 1) ? grid.size[0] - 1 : 0, (corner >> 1 & 1) ? grid.size[1] - 1 : 0,
                                          (corner >> 2) ? grid.size[2] - 1 : 0));
        box.along.add(p.x);
        box.down.add(p.y);
    }
    return box;
}

double under_cut(const CutBone& bone, const PlannedCut& cut, double kerf) {
    const double h = bone.smallest_spacing(), cell = 0.5 * h, reach = 0.5 * kerf + cut.tolerance;
    const PlanBox box = box_of_bone(bone.before, cut);
    const double first = std::max(box.along.low, -cut.half_length), last = std::min(box.along.high, cut.half_length);
    const double deepest = std::min(box.down.high, cut.depth);
    double area = 0.0;
    for (double s = first + 0.5 * cell; s < last; s += cell)
        for (double d = box.down.low + 0.5 * cell; d < deepest; d += cell) {
            if (bone.before_at(cut.position(s, d)) >= 0.0) continue;
            bool is_cut = false;
            for (double n = 0.0; n <= reach && !is_cut; n += 0.5 * h)
                for (const double side : {n, -n}) {
                    const Vec3 p = cut.position(s, d, side);
                    is_cut = is_cut || (bone.after_at(p) > 0.0 && bone.before_at(p) < 0.0);
                }
            if (!is_cut) area += cell * cell;
        }
    return area * kerf;
}

}  // namespace

double CutBone::before_at(const Vec3& p) const noexcept { return value_at(before, p); }
double CutBone::after_at(const Vec3& p) const noexcept { return value_at(after, p); }
double CutBone::smallest_spacing() const noexcept {
    return std::min({before.spacing.x, before.spacing.y, before.spacing.z});
}

volume::Grid after_one_cut(const CutBone& bone, std::span<const PlannedCut> cuts, std::size_t cut) {
    volume::Grid after = bone.after;
    if (cuts.size() < 2) return after;
    std::size_t n = 0;
    for (int k = 0; k < after.size[2]; ++k)
        for (int j = 0; j < after.size[1]; ++j)
            for (int i = 0; i < after.size[0]; ++i, ++n)
                if (after.values[n] != bone.before.values[n] && nearest_cut(cuts, after.position(i, j, k)) != cut)
                    after.values[n] = bone.before.values[n];
    return after;
}

CutVolumes cut_volumes(const CutBone& bone, const PlannedCut& cut, double kerf) {
    const volume::Grid& grid = bone.before;
    const double h = std::cbrt(grid.spacing.x * grid.spacing.y * grid.spacing.z), voxel = h * h * h;
    const double across = 0.5 * kerf + cut.tolerance, down = cut.depth + cut.depth_tolerance,
                 along = cut.half_length + cut.tolerance;
    CutVolumes volumes;
    std::size_t n = 0;
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i, ++n) {
                if (grid.values[n] == bone.after.values[n]) continue;
                const double gone = share_inside(static_cast<double>(grid.values[n]), h) -
                                    share_inside(static_cast<double>(bone.after.values[n]), h);
                if (!(gone > 0.0)) continue;
                const Vec3 p = cut.coordinates(grid.position(i, j, k));
                const double beyond = std::max({std::abs(p.z) - across, p.y - down, std::abs(p.x) - along});
                volumes.removed_m3 += gone * voxel;
                volumes.over_m3 += gone * (1.0 - share_inside(beyond, h)) * voxel;
            }
    volumes.under_m3 = under_cut(bone, cut, kerf);
    return volumes;
}

Severance severance_of(const CutBone& bone, const PlannedCut& cut, const CutPlane& plane, double reach) {
    // Axes within the plane of the cut, as near to those of the plan as the plane permits.
    const Vec3 down = glm::normalize(cut.feed - glm::dot(cut.feed, plane.normal) * plane.normal);
    const Vec3 along = glm::cross(down, plane.normal);
    double middle = 0.0;
    for (const CutPoint& p : plane.points) middle += glm::dot(p.position - plane.point, along);
    middle /= static_cast<double>(std::max<std::size_t>(1, plane.points.size()));
    const double h = bone.smallest_spacing(), step = 0.5 * h;
    Severance found{true};
    bool any = false;
    const double deepest = 0.3;
    for (double s = middle - reach; s <= middle + reach; s += step) {
        const Vec3 start = plane.point + s * along;
        bool is_cut = false, is_whole = false;
        double exit = 0.0;
        for (double d = -deepest; d < deepest; d += step) {
            const Vec3 p = start + d * down;
            if (bone.before_at(p) >= 0.0) continue;
            // Shallow remains are below the accuracy of interpolation.
            const double now = bone.after_at(p);
            is_cut = is_cut || now > 0.0;
            is_whole = is_whole || now < -0.5 * h;
            exit = cut.coordinates(p).y;
        }
        if (is_whole) found.severed = false;
        if (!is_cut) continue;
        const double place = cut.coordinates(start).x;
        found.low = any ? std::min(found.low, place) : place;
        found.high = any ? std::max(found.high, place) : place;
        found.exit = any ? std::max(found.exit, exit) : exit;
        any = true;
    }
    found.severed = found.severed && any;
    return found;
}

}  // namespace tactus::training
