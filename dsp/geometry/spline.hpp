// SPDX-License-Identifier: Apache-2.0
// Cubic spline interpolation on knots with any spacing.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::geometry {

/// Cubic spline (C²) that is a parabola in its first and last interval: exact for parabolas, unlike a natural spline,
/// whose slope at an end is off where the curve bends. Extrapolates linearly beyond its ends.
class Spline {
public:
    /// `x` and `y` have equal length, at least two; `x` strictly increasing. Allocates. Throws Error.
    Spline(std::vector<double> x, std::vector<double> y);

    struct Point {
        double value, slope;
    };
    Point operator()(double x) const noexcept;

    double first() const noexcept { return x_.front(); }
    double last() const noexcept { return x_.back(); }

private:
    std::vector<double> x_, y_, bend_;
};

}  // namespace tactus::geometry
