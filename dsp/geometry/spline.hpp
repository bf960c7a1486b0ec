// SPDX-License-Identifier: Apache-2.0
// A smooth curve through points that need not be evenly spaced.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::geometry {

/// Cubic spline with continuous curvature, straight at its ends; beyond them it goes on straight.
class Spline {
public:
    /// As many `y` as `x`, at least two; `x` strictly increasing. Allocates. Throws Error.
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
