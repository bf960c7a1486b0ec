// SPDX-License-Identifier: Apache-2.0
// A brush on a surface of points: what lies within it gets a label.
#pragma once

#include "dsp/contact/pointshell.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::fit {

/// Points sorted into cubes, so that a stroke looks only where the brush is, and passes over what has its label already.
/// Memory is taken by the constructor.
class SurfaceBrush {
public:
    static constexpr double farthest = 20e-3;  ///< m

    explicit SurfaceBrush(std::vector<contact::SurfacePoint> points);

    /// Labels the points within `radius` (m) of a place.
    void stroke(const Vec3& middle, double radius, std::uint8_t label) noexcept;
    /// From a place to the nearest point, m; `farthest` when there is none so near.
    double distance(const Vec3& place) const noexcept;

    std::span<const contact::SurfacePoint> points() const noexcept { return points_; }
    /// Points whose label is not surface_label::none, and the area that they stand for, m².
    std::size_t labelled() const noexcept { return labelled_; }
    double area() const noexcept { return area_; }

private:
    using Cell = std::array<int, 3>;
    struct Cube {
        std::uint32_t first = 0, end = 0;  ///< in order_
        std::uint32_t uniform = 0;  ///< how many of them have `label`
        std::uint8_t label = 0;
    };

    Cell cell_of(const Vec3& p) const noexcept;
    std::size_t index_of(const Cell& c) const noexcept;
    /// Calls visit(cube, index) for the cubes from low to high, as far as there are any.
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
