// SPDX-License-Identifier: Apache-2.0
#include "tools/window/signal/measures.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::window {

namespace {

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
        if (follows_gap(trace, i)) continue;
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

Trace magnitude_of(const Trace& trace) {
    Trace magnitude{trace.times, std::vector<std::vector<double>>(1), {"magnitude"}, trace.period};
    const std::size_t wide = std::min<std::size_t>(trace.columns.size(), 3);
    magnitude.columns[0].reserve(trace.times.size());
    for (std::size_t i = 0; i < trace.times.size(); ++i) {
        double sum = 0.0;
        for (std::size_t c = 0; c < wide; ++c) sum += trace.columns[c][i] * trace.columns[c][i];
        magnitude.columns[0].push_back(std::sqrt(sum));
    }
    return magnitude;
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

Flaws flaws_of(const Trace& trace, std::size_t column, Range time) {
    Flaws flaws;
    if (column >= trace.columns.size()) return flaws;
    const std::size_t first = index_at(trace, time.low);
    for (std::size_t i = first; i < trace.times.size() && trace.times[i] <= time.high; ++i) {
        if (!std::isfinite(trace.columns[column][i])) ++flaws.not_finite;
        if (!follows_gap(trace, i)) continue;
        // A gap at the left edge is only partly within.
        const double missing = trace.times[i - 1] < time.low
                                   ? std::floor((trace.times[i] - time.low) / trace.period + 1e-6)
                                   : std::round((trace.times[i] - trace.times[i - 1]) / trace.period) - 1.0;
        flaws.missing += static_cast<std::size_t>(std::max(missing, 0.0));
    }
    return flaws;
}

Pairs pairs_of(const Trace& x, std::size_t x_column, const Trace& y, std::size_t y_column, Range time,
               std::size_t most) {
    Pairs pairs;
    if (x_column >= x.columns.size() || y_column >= y.columns.size() || most < 1) return pairs;
    std::size_t first = index_at(y, time.low);
    std::size_t past = first;
    while (past < y.times.size() && y.times[past] <= time.high) ++past;
    pairs.is_cut = past - first > most;
    if (pairs.is_cut) first = past - most;
    const double longest = 1.5 * std::max(x.period, y.period);
    bool is_broken = false;
    for (std::size_t i = first; i < past; ++i) {
        is_broken |= i > first && follows_gap(y, i);
        const auto after = std::ranges::upper_bound(x.times, y.times[i]);
        if (after == x.times.begin()) continue;
        const auto held = static_cast<std::size_t>(after - x.times.begin()) - 1;
        const Point p{x.columns[x_column][held], y.columns[y_column][i]};
        const bool is_there = !(x.period > 0.0) || y.times[i] - x.times[held] <= longest;
        if (!is_there || !std::isfinite(p.x) || !std::isfinite(p.y)) {
            is_broken = true;
            continue;
        }
        if (pairs.points.empty()) pairs.since = y.times[i];
        else if (is_broken) pairs.begins.push_back(pairs.points.size());
        is_broken = false;
        pairs.points.push_back(p);
    }
    return pairs;
}

signal::Spectrum spectrum_of(const Trace& trace, std::size_t column, double rate, Range time, double factor) {
    constexpr std::size_t least = 32;
    if (column >= trace.columns.size()) return {};
    std::vector<std::vector<double>> pieces(1);
    for (std::size_t i = index_at(trace, time.low); i < trace.times.size() && trace.times[i] <= time.high; ++i) {
        const double value = factor * trace.columns[column][i];
        if (!pieces.back().empty() && (follows_gap(trace, i) || !std::isfinite(value))) pieces.emplace_back();
        if (std::isfinite(value)) pieces.back().push_back(value);
    }
    std::size_t longest = 0;
    for (const auto& piece : pieces) longest = std::max(longest, piece.size());
    if (longest < least) return {};
    signal::WelchSettings settings;
    settings.rate = rate;
    settings.segment = signal::suggested_segment(rate, longest);
    settings.overlap = settings.segment / 2;
    signal::WelchStream<double> stream(settings);
    for (const auto& piece : pieces) {
        stream.push(piece);
        stream.forget_waiting();
    }
    return stream.spectrum();
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
    all.bins.assign(all.cells.size(), 0.0);
    if (all.rows < 1) return all;
    const auto per_row = static_cast<std::size_t>(std::round(time.span() * rate / all.rows));
    all.hz.low = rate / static_cast<double>(signal::suggested_segment(rate, per_row));
    for (int row = 0; row < all.rows; ++row) {
        const auto edge_of = [&](int k) { return time.low + time.span() * k / all.rows; };
        // A value belongs to one row only.
        const Range within{edge_of(row), row + 1 < all.rows ? std::nextafter(edge_of(row + 1), time.low) : time.high};
        const signal::Spectrum spectrum = spectrum_of(trace, column, rate, within, factor);
        if (spectrum.power.size() < 2) continue;  // the trace begins later, or has a gap
        const double last = static_cast<double>(spectrum.power.size() - 1);
        for (int c = 0; c < columns; ++c) {
            const auto edge = [&](int k) {
                return all.hz.low * std::pow(all.hz.high / all.hz.low, static_cast<double>(k) / columns) / spectrum.df;
            };
            double begin = std::ceil(edge(c)), end = std::ceil(edge(c + 1)) - 1.0;
            if (end < begin) begin = end = std::round(0.5 * (edge(c) + edge(c + 1)));
            double loudest = std::clamp(begin, 1.0, last);
            const auto power = [&](double k) { return spectrum.power[static_cast<std::size_t>(k)]; };
            for (double k = loudest; k <= std::clamp(end, 1.0, last); ++k)
                if (power(k) > power(loudest)) loudest = k;
            all.cells[all.index_of(row, c)] =
                power(loudest) > 0.0 ? std::max(10.0 * std::log10(power(loudest)), lowest_db) : lowest_db;
            all.bins[all.index_of(row, c)] = loudest * spectrum.df;
        }
    }
    return all;
}

}  // namespace tactus::window
