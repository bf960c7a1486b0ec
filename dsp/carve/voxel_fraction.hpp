// SPDX-License-Identifier: Apache-2.0
// Fraction of a voxel that is bone, from the distance at its centre.
#pragma once

#include "dsp/core/types.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::carve {

/// Fraction of a box on the negative side of a plane at signed distance d from its centre. The sum over a grid is the
/// exact volume below any plane with this normal, for any position of the plane relative to the samples.
class VoxelFraction {
public:
    /// `spacing`: the box, m. `normal`: of the plane, along the grid's axes.
    VoxelFraction(const Vec3& spacing, const Vec3& normal) noexcept {
        const Vec3 shadow = glm::abs(normal) * spacing;
        const double floor = 0.05 * std::max({spacing.x, spacing.y, spacing.z});  // keeps the quotient well conditioned
        const Vec3 w = glm::max(shadow, Vec3(floor));
        half_ = 0.5 * (w.x + w.y + w.z);
        for (int n = 0; n <= steps; ++n) {
            const double d = half_ * (2.0 * n / steps - 1.0);
            table_[static_cast<std::size_t>(n)] = below(-d, w);
        }
        scale_ = steps / (2.0 * half_);
    }

    double operator()(double d) const noexcept {
        const double at = (d + half_) * scale_;
        if (!(at > 0.0)) return 1.0;
        if (at >= steps) return 0.0;
        const auto n = static_cast<std::size_t>(at);
        const double t = at - static_cast<double>(n);
        return table_[n] + t * (table_[n + 1] - table_[n]);
    }

private:
    static constexpr int steps = 128;

    /// Cumulative distribution of the sum of three uniform variables of widths w about zero.
    static double below(double t, const Vec3& w) noexcept {
        double sum = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            const double sx = corner & 1 ? -0.5 : 0.5;
            const double sy = corner & 2 ? -0.5 : 0.5;
            const double sz = corner & 4 ? -0.5 : 0.5;
            const double reach = std::max(0.0, t + sx * w.x + sy * w.y + sz * w.z);
            sum += std::copysign(reach * reach * reach, sx * sy * sz);
        }
        return std::clamp(sum / (6.0 * w.x * w.y * w.z), 0.0, 1.0);
    }

    std::array<double, steps + 1> table_{};
    double half_ = 0.0;
    double scale_ = 0.0;
};

}  // namespace tactus::carve
