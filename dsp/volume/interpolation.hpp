// SPDX-License-Identifier: Apache-2.0
// Interpolation between the samples of a regular grid, with exact derivatives of the interpolant. Slopes are per cell;
// divide by the spacing for gradients.
#pragma once

#include "dsp/core/types.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace tactus::volume {

/// The cell of a grid that contains a position, and the position within it.
struct GridCell {
    int i = 0, j = 0, k = 0;
    double fx = 0.0, fy = 0.0, fz = 0.0;  ///< 0 to 1
    bool inside = false;  ///< false: the position is outside of the grid or not finite
};

/// Finds the cell of a position. `size` samples per axis from `origin` on; positions on the last plane belong to the
/// last cell.
inline GridCell find_grid_cell(const Vec3& origin, const Vec3& spacing, const std::array<int, 3>& size,
                               const Vec3& position) noexcept {
    const double x = (position.x - origin.x) / spacing.x;
    const double y = (position.y - origin.y) / spacing.y;
    const double z = (position.z - origin.z) / spacing.z;
    // The comparison treats NaN and an empty grid as outside.
    if (!(x >= 0.0 && y >= 0.0 && z >= 0.0 && x <= size[0] - 1 && y <= size[1] - 1 && z <= size[2] - 1)) return {};
    const int i = std::min(static_cast<int>(x), size[0] - 2), j = std::min(static_cast<int>(y), size[1] - 2),
              k = std::min(static_cast<int>(z), size[2] - 2);
    return {i, j, k, x - i, y - j, z - k, true};
}

/// An interpolated value and its derivative.
struct Interpolated {
    double value;
    Vec3 slope;  ///< per cell
};

/// Trilinear interpolation between the eight samples of a cell.
struct Trilinear {
    double c000, c100, c010, c110, c001, c101, c011, c111;

    /// `corner` is the sample at the low corner; samples are 1, `row` and `plane` apart along x, y and z.
    Trilinear(const float* corner, std::size_t row, std::size_t plane) noexcept
        : c000(static_cast<double>(corner[0])),
          c100(static_cast<double>(corner[1])),
          c010(static_cast<double>(corner[row])),
          c110(static_cast<double>(corner[row + 1])),
          c001(static_cast<double>(corner[plane])),
          c101(static_cast<double>(corner[plane + 1])),
          c011(static_cast<double>(corner[plane + row])),
          c111(static_cast<double>(corner[plane + row + 1])) {}

    double value(const GridCell& at) const noexcept {
        return mix(mix(mix(c000, c100, at.fx), mix(c010, c110, at.fx), at.fy),
                   mix(mix(c001, c101, at.fx), mix(c011, c111, at.fx), at.fy), at.fz);
    }
    Interpolated operator()(const GridCell& at) const noexcept {
        const double x00 = mix(c000, c100, at.fx), x10 = mix(c010, c110, at.fx);
        const double x01 = mix(c001, c101, at.fx), x11 = mix(c011, c111, at.fx);
        const double y0 = mix(x00, x10, at.fy), y1 = mix(x01, x11, at.fy);
        const double dx = mix(mix(c100 - c000, c110 - c010, at.fy), mix(c101 - c001, c111 - c011, at.fy), at.fz);
        const double dy = mix(x10 - x00, x11 - x01, at.fz);
        return {mix(y0, y1, at.fz), Vec3(dx, dy, y1 - y0)};
    }

private:
    static double mix(double a, double b, double t) noexcept { return a + (b - a) * t; }
};

/// Quadratic B-spline over the 27 samples around the nearest one, with continuous slope; samples are repeated at the
/// border of the grid.
struct QuadraticSpline {
    int index[3][3];  ///< of the three samples, per axis
    double weight[3][3], slope[3][3];

    /// For a position inside the grid.
    QuadraticSpline(const Vec3& origin, const Vec3& spacing, const std::array<int, 3>& size,
                    const Vec3& position) noexcept {
        for (int axis = 0; axis < 3; ++axis) {
            const double x = (position[axis] - origin[axis]) / spacing[axis];
            const int nearest = static_cast<int>(x + 0.5);
            const double t = x - nearest;
            weight[axis][0] = 0.5 * (0.5 - t) * (0.5 - t);
            weight[axis][1] = 0.75 - t * t;
            weight[axis][2] = 0.5 * (0.5 + t) * (0.5 + t);
            slope[axis][0] = t - 0.5;
            slope[axis][1] = -2.0 * t;
            slope[axis][2] = t + 0.5;
            for (int n = 0; n < 3; ++n)
                index[axis][n] = std::clamp(nearest + n - 1, 0, size[static_cast<std::size_t>(axis)] - 1);
        }
    }

    /// `at(i, j, k)` is the i-th sample along x, j-th along y and k-th along z of those in `index`.
    template <class At>
    Interpolated operator()(const At& at) const noexcept {
        double value = 0.0;
        Vec3 change(0.0);
        for (int k = 0; k < 3; ++k)
            for (int j = 0; j < 3; ++j) {
                double along = 0.0, rise = 0.0;
                for (int i = 0; i < 3; ++i) {
                    const double d = at(i, j, k);
                    along += weight[0][i] * d;
                    rise += slope[0][i] * d;
                }
                value += weight[1][j] * weight[2][k] * along;
                change.x += weight[1][j] * weight[2][k] * rise;
                change.y += slope[1][j] * weight[2][k] * along;
                change.z += weight[1][j] * slope[2][k] * along;
            }
        return {value, change};
    }
};

}  // namespace tactus::volume
