// SPDX-License-Identifier: Apache-2.0
// What scopes measure on a trace: crossings of a level, levels in dB, histograms, pairs, spectra over time.
#pragma once

#include "dsp/signal/spectrum/welch.hpp"
#include "tools/window/signal/axis.hpp"
#include "tools/window/signal/feed.hpp"
#include "tools/window/widgets/canvas.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace tactus::window {

inline constexpr double lowest_db = -240.0;  // what silence is shown as

/// First index at or after a time.
inline std::size_t index_at(const Trace& trace, double time) {
    return static_cast<std::size_t>(std::ranges::lower_bound(trace.times, time) - trace.times.begin());
}

/// 20 log10 of an amplitude, dB re 1; -240 for 0 and what is smaller.
double decibels(double amplitude);

/// When a column of a trace passes a level, upwards or downwards.
struct Trigger {
    double level = 0.0;
    bool is_rising = true;
};
/// The latest time in `within` at which it does, between two samples by interpolation; none: it does not.
std::optional<double> trigger_time(const Trace& trace, std::size_t column, const Trigger& trigger, Range within);

/// Of the values in a time range; all 0 without values. Values that are not finite are left out.
struct Level {
    double low = 0.0, high = 0.0, mean = 0.0, rms = 0.0;
    std::size_t count = 0;

    double peak() const;  ///< largest absolute value
};
Level level_of(const Trace& trace, std::size_t column, Range time);

/// A trace of one column: the length of the first three columns.
Trace magnitude_of(const Trace& trace);

/// How many values lie in each of equal parts of their range. The largest value belongs to the last part.
struct Histogram {
    Range values;
    std::vector<std::size_t> counts;
    std::size_t total = 0;
};
Histogram histogram_of(const Trace& trace, std::size_t column, Range time, int parts);

/// Values in a time range that are not finite, and those that are missing between others.
struct Flaws {
    std::size_t not_finite = 0, missing = 0;
};
Flaws flaws_of(const Trace& trace, std::size_t column, Range time);

/// Values of one column over those of another, in the order of time.
struct Pairs {
    std::vector<Point> points;
    std::vector<std::size_t> begins;  ///< points that are not joined to the one before: values are missing between
    double since = 0.0;  ///< s, the time of the first point
    bool is_cut = false;  ///< the range has older ones
};
/// At each time of `y`; the value of `x` is its last one at that time. The newest `most`: leaving some out between
/// would show a curve that never was.
Pairs pairs_of(const Trace& x, std::size_t x_column, const Trace& y, std::size_t y_column, Range time,
               std::size_t most);

/// Welch's spectrum of a column in a time range; no segment has a gap or a value that is not finite. No bins where
/// fewer than 32 values stand together. `factor` scales the values first.
signal::Spectrum spectrum_of(const Trace& trace, std::size_t column, double rate, Range time, double factor = 1.0);

/// Power densities over time and frequency, dB; rows from the oldest time, columns from the lowest frequency, which
/// rise by equal ratios, from one bin on. A cell holds the largest bin in it, or the nearest one.
struct Waterfall {
    Range time, hz;
    int rows = 0, columns = 0;
    std::vector<double> cells;
    std::vector<double> bins;  ///< Hz, of the bin that a cell holds; 0: it holds none

    double at(int row, int column) const { return cells[index_of(row, column)]; }
    std::size_t index_of(int row, int column) const { return static_cast<std::size_t>(row * columns + column); }
};
/// Rows become fewer where one would have less than 64 samples. `factor` scales the values first.
Waterfall waterfall_of(const Trace& trace, std::size_t column, double rate, Range time, int rows, int columns,
                       double factor = 1.0);

}  // namespace tactus::window
