// SPDX-License-Identifier: Apache-2.0
#include "dsp/training/spared.hpp"

#include "dsp/core/rotation.hpp"
#include "dsp/volume/interpolation.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tactus::training {

namespace {

constexpr double fine = 0.05e-3;      // m: half the diagonal of the smallest part of the blade that is looked at
constexpr std::size_t max_parts = 1024;  // of one size

double half_reach(const BladeSize& blade) { return 0.5 * (blade.length + blade.stroke); }

}  // namespace

double SparedStructure::at(const Vec3& point) const noexcept {
    const Vec3 last = distance.position(distance.size[0] - 1, distance.size[1] - 1, distance.size[2] - 1);
    const Vec3 nearest = glm::clamp(point, distance.origin, last);
    const volume::GridCell cell = volume::find_grid_cell(distance.origin, distance.spacing, distance.size, nearest);
    if (!cell.inside) return std::numeric_limits<double>::max();  // a point that is not finite
    const auto line = static_cast<std::size_t>(distance.size[0]);
    const volume::Trilinear corners(&distance.values[distance.index(cell.i, cell.j, cell.k)], line,
                                    line * static_cast<std::size_t>(distance.size[1]));
    return corners.value(cell) + glm::length(point - nearest);
}

double clearance_of(const SparedStructure& structure, const BladeSize& blade, const Pose& pose) noexcept {
    // Branch and bound: the distance changes by no more than one moves, so a part whose middle is farther than the
    // nearest one by more than half its diagonal can be left out. Parts of one size after the other.
    struct Part {
        double x, y;
    };
    std::array<Part, max_parts> parts, next;
    double half_x = half_reach(blade), half_y = 0.5 * blade.height;
    parts[0] = {0.0, -half_y};
    std::size_t count = 1;
    double least = structure.at(pose.position);
    for (;;) {
        const double radius = std::hypot(half_x, half_y);
        std::size_t kept = 0;
        for (std::size_t n = 0; n < count; ++n) {
            const double d = structure.at(pose.apply({parts[n].x, parts[n].y, 0.0}));
            least = std::min(least, d);
            if (d - radius < least - fine) parts[kept++] = parts[n];
        }
        if (radius <= fine || kept == 0 || 2 * kept > max_parts) return least - 0.5 * blade.kerf;
        const bool along = half_x >= half_y;
        (along ? half_x : half_y) *= 0.5;
        const double dx = along ? half_x : 0.0, dy = along ? 0.0 : half_y;
        count = 0;
        for (std::size_t n = 0; n < kept; ++n) {
            next[count++] = {parts[n].x - dx, parts[n].y - dy};
            next[count++] = {parts[n].x + dx, parts[n].y + dy};
        }
        std::copy_n(next.begin(), count, parts.begin());
    }
}

Injury::Injury(const SparedStructure& structure, const BladeSize& blade)
    : structure_(structure), blade_(blade), closest_(std::numeric_limits<double>::infinity()) {
    const volume::Grid& grid = structure.distance;
    voxel_m3_ = grid.spacing.x * grid.spacing.y * grid.spacing.z;
    step_ = 0.25 * std::min({grid.spacing.x, grid.spacing.y, grid.spacing.z});
    reach_ = std::hypot(half_reach(blade), blade.height);
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i)
                if (grid.at(i, j, k) < 0.0f) inside_.push_back(grid.position(i, j, k));
    hit_.assign(inside_.size(), 0);
}

void Injury::move_to(const Pose& pose) {
    if (!is_valid(pose)) return;
    if (!has_begun_) {
        has_begun_ = true;
        last_ = pose;
        return visit(pose);
    }
    const Vec3 turn = rotation_between(last_.orientation, pose.orientation);
    const double moved = glm::length(pose.position - last_.position) + reach_ * glm::length(turn);
    if (moved < safe_) {
        // Nothing within reach: the way is one step.
        safe_ -= moved;
        last_ = pose;
        return;
    }
    const Pose from = last_;
    const int steps = std::clamp(static_cast<int>(std::ceil(moved / step_)), 1, 10'000);
    for (int n = 1; n <= steps; ++n) {
        const double share = static_cast<double>(n) / steps;
        if (moved / steps < safe_ && n < steps) {
            safe_ -= moved / steps;
            continue;
        }
        visit(n == steps ? pose
                         : Pose{from.position + share * (pose.position - from.position),
                                glm::normalize(rotation_by(share * turn) * from.orientation)});
    }
    last_ = pose;
}

void Injury::visit(const Pose& pose) {
    const double clearance = clearance_of(structure_, blade_, pose);
    closest_ = std::min(closest_, clearance);
    // The distance falls at most twice as fast as the blade moves (see SparedStructure::at), and voxels count from
    // their middle, which may lie a cell below the interpolated surface.
    const double margin = 4.0 * step_ + 1e-3;
    safe_ = std::max(0.0, 0.5 * (clearance - std::max(closest_, margin)));
    if (clearance > margin) return;
    const Pose back = pose.inverse();
    const double reach = half_reach(blade_);
    for (std::size_t n = 0; n < inside_.size(); ++n) {
        if (hit_[n]) continue;
        const Vec3 p = back.apply(inside_[n]);
        hit_[n] = std::abs(p.x) <= reach && p.y <= 0.0 && p.y >= -blade_.height && std::abs(p.z) <= 0.5 * blade_.kerf;
    }
}

double Injury::injured_m3() const {
    return voxel_m3_ * static_cast<double>(std::count(hit_.begin(), hit_.end(), std::uint8_t{1}));
}

}  // namespace tactus::training
