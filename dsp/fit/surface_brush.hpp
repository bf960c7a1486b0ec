// SPDX-License-Identifier: Apache-2.0
// Labels the points of a surface within a brush.
#pragma once

#include "dsp/contact/pointshell.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::fit {

/// Points sorted into cubes: a stroke visits only cubes near the brush that do not have its label everywhere. Only the
/// constructor allocates.
class SurfaceBrush {
public:
    static constexpr double farthest = 20e-3;  ///< m

    explicit SurfaceBrush(std::vector<contact::SurfacePoint> points);

    /// Labels the points within `radius` (m) of a position, except those labelled `as_scanned`.
    void stroke(const Vec3& middle, double radius, std::uint8_t label) noexcept;
    /// Distance to the nearest point, m; at most `farthest`.
    double distance(const Vec3& place) const noexcept;

    std::span<const contact::SurfacePoint> points() const noexcept { return points_; }
    /// Number of points with a label other than `none` and `as_scanned`, and their area, m².
    std::size_t labelled() const noexcept { return labelled_; }
    double area() const noexcept { return area_; }

private:
    using Cell = std::array<int, 3>;
    struct Cube {
        std::uint32_t first = 0, end = 0;  ///< in order_
        std::uint32_t uniform = 0;  ///< number of them with `label`
        std::uint8_t label = 0;
    };

    Cell cell_of(const Vec3& p) const noexcept;
    std::size_t index_of(const Cell& c) const noexcept;
    /// Calls visit(cube, index) for the existing cubes from low to high.
    template <class Visit>
    void cubes(const Cell& low, const Cell& high, const Visit& visit) const noexcept;

    std::vector<contact::SurfacePoint> points_;
    std::vector<std::uint32_t> order_;
    std::vector<Cube> cubes_;
    Vec3 origin_{0.0};
    double side_ = 3e-3;  // m
    Cell size_{1, 1, 1};
    std::size_t labelled_ = 0;
    double area_ = 0.0;
};

}  // namespace tactus::fit
