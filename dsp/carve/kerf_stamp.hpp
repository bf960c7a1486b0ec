// SPDX-License-Identifier: Apache-2.0
// Subtracts a swept edge from a distance field.
#pragma once

#include "dsp/carve/settings.hpp"
#include "dsp/carve/swept_edge.hpp"
#include "dsp/carve/voxel_fraction.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::carve {

/// Applies d ← max(d, radius − distance to the swept edge), and measures the removed volume.
struct KerfStamp {
    const Pose& frame;  ///< of the swept edge, in the bone's frame
    double radius;      ///< half the kerf, m
    const SweptEdge& swept;
    const VoxelFraction& fraction;

    /// Processes the voxels of a box in `frame`. Returns false if the field could not store all changes.
    template <class Field>
    bool apply(Field& field, const Vec3& low, const Vec3& high, CarveResult& result) const noexcept {
        const std::array<int, 3> size = field.size();
        const Vec3 spacing = field.spacing();
        std::array<int, 3> first{}, last{};
        const Vec3 centre = (frame.apply(0.5 * (low + high)) - field.origin()) / spacing;
        const Vec3 half = 0.5 * (high - low);
        const Vec3 ax = frame.rotate({1, 0, 0}), ay = frame.rotate({0, 1, 0}), az = frame.rotate({0, 0, 1});
        for (int axis = 0; axis < 3; ++axis) {
            const double extent =
                (std::abs(ax[axis]) * half.x + std::abs(ay[axis]) * half.y + std::abs(az[axis]) * half.z) /
                spacing[axis];
            const auto a = static_cast<std::size_t>(axis);
            first[a] = static_cast<int>(std::ceil(std::clamp(centre[axis] - extent, 0.0, 1e6)));
            last[a] = static_cast<int>(std::floor(std::clamp(centre[axis] + extent, -1.0, size[a] - 1.0)));
        }
        const Pose back = frame.inverse();
        const Vec3 step = back.rotate({spacing.x, 0, 0});
        bool whole = true;
        for (int k = first[2]; k <= last[2]; ++k) {
            for (int j = first[1]; j <= last[1]; ++j) {
                const Vec3 start = back.apply(field.origin() + Vec3(0.0, j, k) * spacing);
                double from = first[0], to = last[0];
                clip(low, high, start, step, from, to);
                if (!(from <= to)) continue;  // for a nearly level row, `from` may exceed the range of int
                const int stop = static_cast<int>(std::floor(to));
                for (int i = static_cast<int>(std::ceil(from)); i <= stop; ++i) {
                    const double before = field.get(i, j, k);
                    if (before >= radius) continue;  // most samples: their positions are not needed
                    whole &= lift(field, i, j, k, before, start + step * static_cast<double>(i), result);
                }
            }
        }
        return whole;
    }

private:
    /// Clips [from, to] to the part where start + i·step is in the box.
    static void clip(const Vec3& low, const Vec3& high, const Vec3& start, const Vec3& step, double& from,
                     double& to) noexcept {
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(step[axis]) < 1e-12) {
                if (start[axis] < low[axis] || start[axis] >= high[axis]) to = from - 1.0;
                continue;
            }
            const double a = (low[axis] - start[axis]) / step[axis], b = (high[axis] - start[axis]) / step[axis];
            from = std::max(from, std::min(a, b));
            to = std::min(to, std::max(a, b));
        }
    }

    template <class Field>
    bool lift(Field& field, int i, int j, int k, double before, const Vec3& p, CarveResult& result) const noexcept {
        const double limit = (radius - before) * (radius - before);
        const double squared = swept.squared_distance(p, limit);
        if (squared >= limit) return true;
        const auto after = static_cast<float>(radius - std::sqrt(squared));
        if (after <= static_cast<float>(before)) return true;
        if (!field.set(i, j, k, after)) return false;
        const double gone = fraction(before) - fraction(static_cast<double>(after));
        if (gone > 0.0) {
            const Vec3 spacing = field.spacing();
            const double volume = gone * spacing.x * spacing.y * spacing.z;
            const double density = field.density(field.origin() + Vec3(i, j, k) * spacing);
            std::size_t kind = 0;
            while (kind < density_class_limits.size() && density >= density_class_limits[kind]) ++kind;
            result.removed_m3 += volume;
            result.removed_by_density[kind] += volume;
        }
        return true;
    }
};

}  // namespace tactus::carve
