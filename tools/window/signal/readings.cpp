// SPDX-License-Identifier: Apache-2.0
#include "tools/window/signal/readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace tactus::window {

namespace {

/// The value of a column at a time; none outside of the trace.
std::optional<double> value_at(const Trace& trace, std::size_t column, double time) {
    const auto after = std::ranges::lower_bound(trace.times, time);
    if (after == trace.times.end() || column >= trace.columns.size()) return std::nullopt;
    const auto i = static_cast<std::size_t>(after - trace.times.begin());
    const std::vector<double>& values = trace.columns[column];
    if (trace.times[i] == time) return values[i];
    if (i == 0 || follows_gap(trace, i)) return std::nullopt;
    const double share = (time - trace.times[i - 1]) / (trace.times[i] - trace.times[i - 1]);
    return values[i - 1] + share * (values[i] - values[i - 1]);
}

/// The values of the columns that are drawn, "0.5, 1.2, -3 mm".
std::string values_words(const DrawnTrace& drawn, double time, std::optional<double> from) {
    std::string words;
    const std::size_t count = std::min(drawn.display.columns, drawn.trace->columns.size());
    for (std::size_t c = 0; c < count; ++c) {
        const auto here = value_at(*drawn.trace, c, time);
        const auto there = from ? value_at(*drawn.trace, c, *from) : std::optional(0.0);
        words += c > 0 ? ", " : "";
        words += here && there ? fmt::format("{:.4g}", (*here - *there) * drawn.display.factor) : "–";
    }
    return words + (drawn.display.unit.empty() ? "" : " " + drawn.display.unit);
}

const Curve* first_curve(const Plot& plot) {
    const auto found = std::ranges::find(plot.curves, false, &Curve::is_reference);
    return found == plot.curves.end() || found->points.empty() ? nullptr : &*found;
}

std::string hz_words(double hz) { return fmt::format("{:.5g} Hz", hz); }

/// A position and its level; two: the differences.
template <class LevelAt>
std::string level_at_words(const Plot& plot, std::span<const Point> at, LevelAt&& level_at) {
    const auto first = level_at(at[0]);
    if (!first) return {};
    if (at.size() == 1) return fmt::format("{}: {:.2f} {}", hz_words(first->x), first->y, plot.level_unit);
    const auto second = level_at(at[1]);
    if (!second) return {};
    return fmt::format("Δ {}, Δ {:.2f} dB", hz_words(second->x - first->x), second->y - first->y);
}

std::string with_unit(double value, const std::string& unit) {
    return unit.empty() ? fmt::format("{:.4g}", value) : fmt::format("{:.4g} {}", value, unit);
}

}  // namespace

std::string span_words(double seconds) {
    return std::abs(seconds) < 1.0 ? fmt::format("{:.3f} ms", 1e3 * seconds) : fmt::format("{:.4f} s", seconds);
}

std::string level_words(const Level& level, const std::string& unit, const std::string& column) {
    if (level.count == 0) return {};
    return fmt::format("{}peak {:.2f} dB, rms {:.2f} dB re 1{}", column.empty() ? "" : column + ": ",
                       decibels(level.peak()), decibels(level.rms), unit.empty() ? "" : " " + unit);
}

std::string flaw_words(const Flaws& flaws) {
    const auto said = [](std::size_t count, const char* what) {
        return count == 0 ? std::string() : fmt::format("{} value{} {}", count, count > 1 ? "s" : "", what);
    };
    const std::string lost = said(flaws.missing, "lost"), odd = said(flaws.not_finite, "not finite");
    return lost + (lost.empty() || odd.empty() ? "" : ", ") + odd;
}

std::string wave_words(const Plot& plot, const DrawnTrace& drawn, std::span<const Point> at) {
    if (at.empty() || !drawn.trace) return {};
    const double first = plot.origin + at[0].x;
    if (at.size() == 1)
        return fmt::format("{}: {}", plot.origin != 0.0 ? span_words(at[0].x) : fmt::format("{:.6f} s", at[0].x),
                           values_words(drawn, first, std::nullopt));
    const double second = plot.origin + at[1].x, apart = at[1].x - at[0].x;
    std::string words = fmt::format("Δ {}, Δ {}", span_words(apart), values_words(drawn, second, first));
    if (apart != 0.0) words += ", " + hz_words(1.0 / std::abs(apart));
    return words;
}

std::string spectrum_words(const Plot& plot, std::span<const Point> at) {
    const Curve* curve = first_curve(plot);
    if (at.empty() || !curve) return {};
    return level_at_words(plot, at, [&](const Point& p) {
        return std::optional(
            *std::ranges::min_element(curve->points, {}, [&](const Point& q) { return std::abs(q.x - p.x); }));
    });
}

std::string waterfall_words(const Plot& plot, std::span<const Point> at) {
    if (at.empty() || !plot.waterfall || plot.waterfall->rows == 0) return {};
    const Waterfall& all = *plot.waterfall;
    return level_at_words(plot, at, [&](const Point& p) -> std::optional<Point> {
        const auto cell = [](double share, int count) {
            return std::clamp(static_cast<int>(std::floor(share * count)), 0, count - 1);
        };
        const int row = cell((p.y - all.time.low) / all.time.span(), all.rows),
                  column = cell(plot.across(p.x), all.columns);
        const double hz = all.bins[all.index_of(row, column)];
        return hz > 0.0 ? std::optional(Point{hz, all.at(row, column)}) : std::nullopt;
    });
}

std::string histogram_words(const Plot& plot, std::span<const Point> at) {
    const Curve* curve = first_curve(plot);
    if (at.empty() || !curve) return {};
    // A part is four points: up at its left edge, down at its right one.
    const auto percent_below = [&](double x) {
        double sum = 0.0;
        for (std::size_t i = 0; i + 3 < curve->points.size(); i += 4) {
            const Point &left = curve->points[i + 1], &right = curve->points[i + 2];
            sum += left.y * std::clamp((x - left.x) / (right.x - left.x), 0.0, 1.0);
        }
        return sum;
    };
    if (at.size() == 2)
        return fmt::format("Δ {}, {:.2f} % between", with_unit(at[1].x - at[0].x, plot.x_unit),
                           std::abs(percent_below(at[1].x) - percent_below(at[0].x)));
    for (std::size_t i = 0; i + 3 < curve->points.size(); i += 4) {
        const Point &left = curve->points[i + 1], &right = curve->points[i + 2];
        const bool is_last = i + 7 >= curve->points.size();
        if (at[0].x >= left.x && (at[0].x < right.x || (is_last && at[0].x <= right.x)))
            return fmt::format("{:.4g} to {}: {:.2f} %", left.x, with_unit(right.x, plot.x_unit), left.y);
    }
    return with_unit(at[0].x, plot.x_unit) + ": 0 %";
}

std::string xy_words(const Plot& plot, std::span<const Point> at) {
    if (at.empty()) return {};
    if (at.size() == 1) return fmt::format("{}, {}", with_unit(at[0].x, plot.x_unit), with_unit(at[0].y, plot.y_unit));
    return fmt::format("Δ {}, Δ {}", with_unit(at[1].x - at[0].x, plot.x_unit),
                       with_unit(at[1].y - at[0].y, plot.y_unit));
}

}  // namespace tactus::window
