// SPDX-License-Identifier: Apache-2.0
// Axes of a plot: where their ticks stand, how far they reach.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace tactus::view {

struct Range {
    double low = 0.0, high = 1.0;

    double span() const { return high - low; }
    bool operator==(const Range&) const = default;
};

/// Round numbers 1, 2 or 5 · 10ⁿ apart within the range, at most `most` of them. Empty for a range that is none.
std::vector<double> linear_ticks(Range range, int most);
/// 1, 2 and 5 of each decade, or the decades alone when those are more than `most`. For ranges above zero.
std::vector<double> decade_ticks(Range range, int most);
/// "0.25", "-1.5e-07": as many digits as tell neighbours `step` apart from each other.
std::string tick_label(double value, double step);

/// A range that shows all values with some air, and that stays what it was while it still fits well.
Range fitted(Range shown, Range values);

/// Least and greatest value in each of `columns` equal parts of the time range; NaN where there is none. Times rise.
struct Envelope {
    std::vector<double> low, high;
};
Envelope envelope_of(std::span<const double> times, std::span<const double> values, Range time, int columns);

}  // namespace tactus::view
