// SPDX-License-Identifier: Apache-2.0
#include "tools/view/signal/measures.hpp"

#include "dsp/signal/spectrum/welch.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::view {

namespace {

constexpr double lowest_db = -240.0;

/// First index at or after a time.
std::size_t index_at(const Trace& trace, double time) {
    return static_cast<std::size_t>(std::ranges::lower_bound(trace.times, time) - trace.times.begin());
}

/// Calls with each finite value of a column in a time range.
template <class See>
void for_each_value(const Trace& trace, std::size_t column, Range time, See&& see) {
    if (column >= trace.columns.size()) return;
    const std::vector<double>& values = trace.columns[column];
    for (std::size_t i = index_at(trace, time.low); i < trace.times.size() && trace.times[i] <= time.high; ++i)
        if (std::isfinite(values[i])) see(values[i]);
}

}  // namespace

double decibels(double amplitude) {
    return amplitude > 0.0 ? std::max(20.0 * std::log10(amplitude), lowest_db) : lowest_db;
}

std::optional<double> trigger_time(const Trace& trace, std::size_t column, const Trigger& trigger, Range within) {
    if (column >= trace.columns.size()) return std::nullopt;
    const std::vector<double>& values = trace.columns[column];
    const double sign = trigger.is_rising ? 1.0 : -1.0;
    std::size_t i = index_at(trace, within.high);
    // The pair of samples between which the range ends counts, too.
    i = std::min(i + 1, trace.times.size());
    while (i-- > 1) {
        if (trace.times[i] < within.low) return std::nullopt;
        const double before = sign * (values[i - 1] - trigger.level), after = sign * (values[i] - trigger.level);
        if (!(before < 0.0 && after >= 0.0)) continue;
        const double time = trace.times[i - 1] + (trace.times[i] - trace.times[i - 1]) * (before / (before - after));
        if (time >= within.low && time <= within.high) return time;
    }
    return std::nullopt;
}

double Level::peak() const { return std::max(std::abs(low), std::abs(high)); }

Level level_of(const Trace& trace, std::size_t column, Range time) {
    Level level;
    double sum = 0.0, squares = 0.0;
    for_each_value(trace, column, time, [&](double value) {
        level.low = level.count == 0 ? value : std::min(level.low, value);
        level.high = level.count == 0 ? value : std::max(level.high, value);
        sum += value;
        squares += value * value;
        ++level.count;
    });
    if (level.count == 0) return level;
    level.mean = sum / static_cast<double>(level.count);
    level.rms = std::sqrt(squares / static_cast<double>(level.count));
    return level;
}

Histogram histogram_of(const Trace& trace, std::size_t column, Range time, int parts) {
    Histogram histogram;
    const Level level = level_of(trace, column, time);
    if (level.count == 0 || parts < 1) return histogram;
    histogram.values = {level.low, level.high};
    // One value has a range of its own.
    if (!(histogram.values.span() > 0.0)) {
        const double around = level.low != 0.0 ? 0.01 * std::abs(level.low) : 0.5;
        histogram.values = {level.low - around, level.low + around};
    }
    histogram.counts.assign(static_cast<std::size_t>(parts), 0);
    for_each_value(trace, column, time, [&](double value) {
        const double share = (value - histogram.values.low) / histogram.values.span();
        ++histogram.counts[std::min(static_cast<std::size_t>(share * parts), static_cast<std::size_t>(parts - 1))];
        ++histogram.total;
    });
    return histogram;
}

std::vector<Point> pairs_of(const Trace& x, std::size_t x_column, const Trace& y, std::size_t y_column, Range time,
                            std::size_t most) {
    std::vector<Point> points;
    if (x_column >= x.columns.size() || y_column >= y.columns.size() || most < 1) return points;
    const std::size_t first = index_at(y, time.low);
    std::size_t past = first;
    while (past < y.times.size() && y.times[past] <= time.high) ++past;
    const std::size_t step = std::max<std::size_t>(1, (past - first + most - 1) / most);
    for (std::size_t i = first; i < past; i += step) {
        const auto after = std::ranges::upper_bound(x.times, y.times[i]);
        if (after == x.times.begin()) continue;
        const Point p{x.columns[x_column][static_cast<std::size_t>(after - x.times.begin()) - 1],
                      y.columns[y_column][i]};
        if (std::isfinite(p.x) && std::isfinite(p.y)) points.push_back(p);
    }
    return points;
}

Waterfall waterfall_of(const Trace& trace, std::size_t column, double rate, Range time, int rows, int columns,
                       double factor) {
    Waterfall all;
    all.time = time;
    all.hz = {std::max(10.0, 2.0 / time.span()), 0.5 * rate};
    if (all.hz.high <= 2.0 * all.hz.low) all.hz.low = 0.05 * rate;
    if (column >= trace.columns.size() || !(time.span() > 0.0) || columns < 1) return all;
    all.rows = std::clamp(static_cast<int>(time.span() * rate / 64.0), 0, rows);
    all.columns = columns;
    all.cells.assign(static_cast<std::size_t>(all.rows) * static_cast<std::size_t>(columns), lowest_db);
    for (int row = 0; row < all.rows; ++row) {
        const std::size_t from = index_at(trace, time.low + time.span() * row / all.rows),
                          to = index_at(trace, time.low + time.span() * (row + 1) / all.rows);
        if (to < from + 32) continue;  // the trace begins later, or has a gap
        std::vector<double> record(trace.columns[column].begin() + static_cast<std::ptrdiff_t>(from),
                                   trace.columns[column].begin() + static_cast<std::ptrdiff_t>(to));
        for (double& x : record) x = std::isfinite(x) ? factor * x : 0.0;
        signal::WelchSettings settings;
        settings.rate = rate;
        settings.segment = signal::suggested_segment(rate, record.size());
        settings.overlap = settings.segment / 2;
        const signal::Spectrum spectrum = signal::welch<double>(record, settings);
        if (spectrum.power.size() < 2) continue;
        const double last = static_cast<double>(spectrum.power.size() - 1);
        for (int c = 0; c < columns; ++c) {
            const auto edge = [&](int k) {
                return all.hz.low * std::pow(all.hz.high / all.hz.low, static_cast<double>(k) / columns) / spectrum.df;
            };
            double begin = std::ceil(edge(c)), end = std::ceil(edge(c + 1)) - 1.0;
            if (end < begin) begin = end = std::round(0.5 * (edge(c) + edge(c + 1)));
            double power = 0.0;
            for (double k = std::clamp(begin, 1.0, last); k <= std::clamp(end, 1.0, last); ++k)
                power = std::max(power, spectrum.power[static_cast<std::size_t>(k)]);
            all.cells[static_cast<std::size_t>(row * columns + c)] =
                power > 0.0 ? std::max(10.0 * std::log10(power), lowest_db) : lowest_db;
        }
    }
    return all;
}

}  // namespace tactus::view
