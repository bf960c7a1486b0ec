// SPDX-License-Identifier: Apache-2.0
// Ticks and ranges of plot axes.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace tactus::window {

struct Range {
    double low = 0.0, high = 1.0;

    double span() const { return high - low; }
    bool operator==(const Range&) const = default;
};

/// Round numbers with steps of 1, 2 or 5 · 10ⁿ within the range, at most `most`. Empty for an invalid range.
std::vector<double> linear_ticks(Range range, int most);
/// 1, 2 and 5 of each decade, or only the decades when there would be more than `most`. For positive ranges.
std::vector<double> decade_ticks(Range range, int most);
/// "0.25", "-1.5e-07": enough digits to distinguish values `step` apart.
std::string tick_label(double value, double step);

/// A range with a margin around all values; keeps the old range while it still fits well.
Range fitted(Range shown, Range values);

/// Minimum and maximum in each of `columns` equal parts of the time range; NaN for parts without a finite value. Times
/// must increase. With a period (s), times that lie more than 1.5 periods apart have a gap between them.
struct Envelope {
    std::vector<double> low, high;
    std::vector<bool> begins;  ///< a gap or a value that is not finite lies before the part's first finite value
};
Envelope envelope_of(std::span<const double> times, std::span<const double> values, Range time, int columns,
                     double period = 0.0);

}  // namespace tactus::window
