// SPDX-License-Identifier: Apache-2.0
// How fast the value of a formula can change, found without running it.
#pragma once

#include "graph/formula/program.hpp"

#include <limits>
#include <span>
#include <vector>

namespace tactus::formula {

/// All values from low to high.
struct Interval {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();

    bool is_point() const { return low == high; }
    bool operator==(const Interval&) const = default;
};

/// For each variable the largest absolute slope of the result over it, while every variable is in its range; infinite
/// where there is a jump or no bound was found. Interval arithmetic with derivatives carried forward (Moore,
/// Methods and Applications of Interval Analysis, 1979, section 3.4): never too small but for rounding, often too
/// large, as in x - x.
std::vector<double> slope_bounds(const Program& program, std::span<const Interval> ranges);

}  // namespace tactus::formula
