// SPDX-License-Identifier: Apache-2.0
#include "tools/report/sweep/sweep_figure.hpp"

#include "dsp/core/error.hpp"
#include "tools/counted.hpp"
#include "tools/report/figures/axes.hpp"
#include "tools/report/figures/heat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace tactus::report {

namespace {

using analysis::FigureCell;
using analysis::FigureData;
using display::Colour;
using display::Figure;
using display::FigurePoint;
using sweep::FigureChoice;

constexpr double panel_gap = 96.0, top = 62.0, bottom = 60.0, line_height = 230.0, row_gap = 84.0, legend_width = 150.0;

std::string axis_title(const sweep::Axis& axis) {
    return axis.has_numbers && !axis.unit.empty() ? fmt::format("{}, {}", axis.name, axis.unit) : axis.name;
}

std::string short_text(std::string text) {
    constexpr std::size_t most = 24;
    if (text.size() <= most) return text;
    std::size_t end = most;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
    return text.substr(0, end) + "…";
}

/// Of a file: its name, without folder and extension.
std::string level_text(const sweep::Axis& axis, std::size_t level) {
    if (!axis.files.empty()) return short_text(axis.files[level].stem().string());
    return short_text(axis.has_numbers ? fmt::format("{:.4g}", axis.levels[level].number) : axis.levels[level].text);
}

std::string value_title(const FigureChoice& choice) {
    const bool is_mean = choice.statistic == FigureChoice::Statistic::mean;
    std::string text(is_mean ? "" : sweep::name_of(choice.statistic));
    if (choice.values.size() > 1)
        text = choice.minus.empty() ? std::string(sweep::name_of(choice.statistic)) : "difference";
    else {
        const std::string name = choice.minus.empty()
                                     ? choice.values.front()
                                     : fmt::format("{} − {}", choice.values.front(), choice.minus.front());
        text = is_mean ? name : fmt::format("{}: {}", text, name);
    }
    return choice.unit.empty() ? text : fmt::format("{}, {}", text, choice.unit);
}

std::string panel_title(const FigureData& data, std::size_t panel) {
    return data.panel ? fmt::format("{} = {}", data.panel->name, level_text(*data.panel, panel)) : std::string();
}

std::string heading(const FigureData& data) {
    return data.choice.title.empty() ? value_title(data.choice) : data.choice.title;
}

std::string note(const FigureData& data) {
    const bool is_fraction = data.choice.statistic == FigureChoice::Statistic::fraction;
    const char* interval = is_fraction && !data.choice.minus.empty()                  ? "Newcombe"
                           : is_fraction                                              ? "Wilson"
                           : data.choice.statistic == FigureChoice::Statistic::median ? "order statistics"
                                                                                      : "t";
    std::size_t least = SIZE_MAX, most = 0;
    for (const FigureCell& cell : data.cells) {
        least = std::min(least, cell.count);
        most = std::max(most, cell.count);
    }
    std::string text = least == most ? fmt::format("n = {}", least) : fmt::format("n = {} to {}", least, most);
    const bool has_bars =
        std::ranges::any_of(data.cells, [](const FigureCell& cell) { return cell.interval.has_value(); });
    if (data.choice.kind == FigureChoice::Kind::lines && has_bars) text += fmt::format("; bars: 95 % ({})", interval);
    if (!data.choice.minus.empty()) text += "; differences are paired";
    if (data.left_out > 0) text += fmt::format("; {} left out", counted(data.left_out, "value"));
    return text;
}

/// Position of the levels of an axis: numbers to scale, texts evenly.
struct Positions {
    std::vector<double> at;
    Scale scale{0.0, 1.0, false};
    bool has_names = false;

    explicit Positions(const sweep::Axis& axis) {
        double low = 1e300, high = -1e300;
        for (const sweep::Level& level : axis.levels) {
            const double v = axis.has_numbers ? level.number : static_cast<double>(at.size() + 1);
            at.push_back(v);
            low = std::min(low, v);
            high = std::max(high, v);
        }
        has_names = !axis.has_numbers;
        const bool is_log = axis.has_numbers && low > 0.0 && (axis.is_log || high / low >= 10.0);
        if (is_log) {
            const double pad = low == high ? 2.0 : std::pow(high / low, 0.06);
            scale = {low / pad, high * pad, true};
        } else {
            const double pad = has_names     ? 0.5
                               : low == high ? std::max(0.5 * std::abs(low), 1e-9)
                                             : 0.06 * (high - low);
            scale = {low - pad, high + pad, false, has_names ? HUGE_VAL : 0.0};
        }
    }
};

struct Range {
    double low = 1e300, high = -1e300;
    void add(double v) {
        low = std::min(low, v);
        high = std::max(high, v);
    }
};

Scale value_scale(const FigureData& data) {
    const bool is_difference = !data.choice.minus.empty();
    if (data.choice.statistic == FigureChoice::Statistic::fraction && !is_difference) return {0.0, 1.0, false, 0.25};
    Range range;
    for (const FigureCell& cell : data.cells)
        for (const double v : {cell.value, cell.interval ? cell.interval->first : cell.value,
                               cell.interval ? cell.interval->second : cell.value})
            if (!data.choice.is_log || v > 0.0) range.add(v);
    if (data.choice.is_log) {
        if (range.low > range.high) throw Error("a logarithmic figure needs values above 0");
        return {range.low / 1.3, range.high * 1.3, true};
    }
    if (is_difference) range.add(0.0);
    const double pad =
        range.low == range.high ? std::max(0.1 * std::abs(range.low), 1e-9) : 0.06 * (range.high - range.low);
    return {range.low - pad, range.high + pad, false};
}

/// Panels in rows of at most three.
struct Layout {
    std::size_t panels, across;
    double width, height;

    FigurePoint corner(std::size_t panel) const {
        return {72.0 + (width + panel_gap) * static_cast<double>(panel % across),
                top + (height + row_gap) * static_cast<double>(panel / across)};
    }
    Figure figure(double right) const {
        const auto rows = static_cast<double>((panels + across - 1) / across);
        return {72.0 + (width + panel_gap) * static_cast<double>(across) + right,
                top + (height + row_gap) * rows - row_gap + bottom + 18.0};
    }
};

Figure draw_lines(const FigureData& data) {
    const Layout layout{data.panel ? data.panel->levels.size() : 1,
                        std::min<std::size_t>(3, data.panel ? data.panel->levels.size() : 1), 260.0, line_height};
    const std::size_t lines = data.line_count();
    Figure figure = layout.figure(lines > 1 || data.series ? legend_width : 0.0);
    const Positions across(*data.x);
    const Scale up = value_scale(data);
    for (std::size_t p = 0; p < layout.panels; ++p) {
        const FigurePoint corner = layout.corner(p);
        const Axes axes{figure, corner.x, corner.y, layout.width, layout.height, across.scale, up};
        axes.draw(panel_title(data, p), across.has_names ? "" : axis_title(*data.x), value_title(data.choice));
        if (across.has_names) {
            std::size_t longest = 0;
            for (std::size_t l = 0; l < across.at.size(); ++l)
                longest = std::max(longest, level_text(*data.x, l).size());
            // Long names in two rows.
            const double room = layout.width / static_cast<double>(across.at.size());
            const double drop = 6.0 * static_cast<double>(longest) > room ? 12.0 : 0.0;
            for (std::size_t l = 0; l < across.at.size(); ++l)
                figure.text(
                    {axes.at(across.at[l], up.low).x, corner.y + layout.height + 14.0 + (l % 2 == 1 ? drop : 0.0)},
                    level_text(*data.x, l), 10.0, axis_ink, display::TextAnchor::middle);
            figure.text({corner.x + layout.width, corner.y + layout.height + 28.0 + drop}, data.x->name, 10.0,
                        axis_soft, display::TextAnchor::end);
        }
        if (!data.choice.minus.empty()) axes.level(0.0, axis_soft, "");
        for (std::size_t s = 0; s < lines; ++s) {
            const Colour colour = curve_colours[s % curve_colours.size()];
            std::vector<FigurePoint> curve;
            for (const FigureCell& cell : data.cells) {
                if (cell.panel != p || FigureData::line_of(cell) != s || (up.is_log && cell.value <= 0.0)) continue;
                const double x = across.at[cell.x];
                const auto [from, to] = cell.interval.value_or(std::pair(cell.value, cell.value));
                FigurePoint at = axes.at(x, cell.value), low = axes.at(x, up.is_log ? std::max(from, up.low) : from),
                            high = axes.at(x, to);
                // Beside each other, so that equal values of two lines are both seen.
                const double aside = 4.0 * (static_cast<double>(s) - 0.5 * static_cast<double>(lines - 1));
                for (FigurePoint* point : {&at, &low, &high}) point->x += aside;
                curve.push_back(at);
                figure.rectangle(at.x - 2.5, at.y - 2.5, 5.0, 5.0, colour);
                if (!cell.interval) continue;
                figure.line({low, high}, colour, 1.2);
                for (const FigurePoint end : {low, high})
                    figure.line({{end.x - 3.0, end.y}, {end.x + 3.0, end.y}}, colour, 1.2);
            }
            if (curve.size() > 1) figure.line(curve, colour, 1.5, 3.0 * static_cast<double>(s / curve_colours.size()));
        }
    }
    for (std::size_t s = 0; (lines > 1 || data.series) && s < lines; ++s) {
        const double x = figure.width() - legend_width - 6.0, y = top + 18.0 * static_cast<double>(s) + 18.0;
        if (s == 0 && data.series) figure.text({x, top + 2.0}, short_text(axis_title(*data.series)), 10.0, axis_soft);
        figure.line({{x, y - 3.5}, {x + 16.0, y - 3.5}}, curve_colours[s % curve_colours.size()], 2.5,
                    3.0 * static_cast<double>(s / curve_colours.size()));
        figure.text({x + 21.0, y}, data.series ? level_text(*data.series, s) : short_text(data.choice.values[s]), 10.0,
                    axis_ink);
    }
    return figure;
}

Figure draw_heat(const FigureData& data) {
    const std::size_t columns = data.x->levels.size(), rows = data.y->levels.size();
    constexpr std::size_t max_named = 16;
    const double wide = columns <= 12 ? 46.0 : std::max(4.0, 552.0 / static_cast<double>(columns)),
                 high = rows <= 12 ? 30.0 : std::max(4.0, 360.0 / static_cast<double>(rows));
    const Layout layout{data.panel ? data.panel->levels.size() : 1,
                        std::min<std::size_t>(3, data.panel ? data.panel->levels.size() : 1),
                        wide * static_cast<double>(columns), high * static_cast<double>(rows)};
    Figure figure = layout.figure(60.0);
    Range range;
    for (const FigureCell& cell : data.cells)
        if (!data.choice.is_log || cell.value > 0.0) range.add(cell.value);
    if (range.low > range.high) throw Error("a logarithmic figure needs values above 0");
    if (data.choice.statistic == FigureChoice::Statistic::fraction && data.choice.minus.empty()) range = {0.0, 1.0};
    const bool is_log = data.choice.is_log;
    const auto share = [&](double v) {
        if (range.low == range.high) return 0.5;
        if (is_log) return v <= 0.0 ? 0.0 : std::log(v / range.low) / std::log(range.high / range.low);
        return (v - range.low) / (range.high - range.low);
    };
    for (std::size_t p = 0; p < layout.panels; ++p) {
        const FigurePoint corner = layout.corner(p);
        figure.text({corner.x, corner.y - 7.0}, panel_title(data, p), 11.0, axis_ink, display::TextAnchor::start, true);
        for (const FigureCell& cell : data.cells) {
            if (cell.panel != p) continue;
            const double x = corner.x + wide * static_cast<double>(cell.x),
                         y = corner.y + layout.height - high * static_cast<double>(cell.y + 1);
            const double at = share(cell.value);
            figure.rectangle(x, y, wide - 0.5, high - 0.5, heat(at));
            if (columns <= 12 && rows <= 12)
                figure.text({x + 0.5 * wide, y + 0.5 * high + 3.5}, fmt::format("{:.3g}", cell.value), 10.0,
                            at > 0.55 ? Colour{0, 0, 0} : Colour{255, 255, 255}, display::TextAnchor::middle);
        }
        const std::size_t every_x = (columns + max_named - 1) / max_named, every_y = (rows + max_named - 1) / max_named;
        for (std::size_t i = 0; i < columns; i += every_x)
            figure.text({corner.x + wide * (static_cast<double>(i) + 0.5), corner.y + layout.height + 14.0},
                        level_text(*data.x, i), 10.0, axis_ink, display::TextAnchor::middle);
        for (std::size_t i = 0; i < rows; i += every_y)
            figure.text({corner.x - 6.0, corner.y + layout.height - high * (static_cast<double>(i) + 0.5) + 3.5},
                        level_text(*data.y, i), 10.0, axis_ink, display::TextAnchor::end);
        figure.text({corner.x + layout.width, corner.y + layout.height + 28.0}, axis_title(*data.x), 10.0, axis_soft,
                    display::TextAnchor::end);
        figure.text({corner.x - 52.0, corner.y + 0.5 * layout.height}, axis_title(*data.y), 10.0, axis_soft,
                    display::TextAnchor::middle, false, true);
    }
    const double x = figure.width() - 96.0, bar = std::max(layout.height, 60.0);
    for (int i = 0; i < heat_shades; ++i)
        figure.rectangle(x, top + bar * (1.0 - static_cast<double>(i + 1) / heat_shades), 12.0, bar / heat_shades + 0.5,
                         heat_of_shade(i));
    for (int i = 0; i <= 2; ++i) {
        const double part = 0.5 * i;
        const double v =
            is_log ? range.low * std::pow(range.high / range.low, part) : range.low + part * (range.high - range.low);
        figure.text({x + 17.0, top + bar * (1.0 - part) + 3.5}, fmt::format("{:.3g}", v), 10.0, axis_ink);
    }
    return figure;
}

}  // namespace

Figure draw_sweep(const FigureData& data) {
    if (data.cells.empty())
        throw Error(fmt::format("no finished point has a number '{}' yet", data.choice.values.front()));
    const bool is_heat = data.choice.kind == FigureChoice::Kind::heat;
    Figure figure = is_heat ? draw_heat(data) : draw_lines(data);
    figure.text({20.0, 24.0}, heading(data), 14.0, axis_ink, display::TextAnchor::start, true);
    figure.text({20.0, figure.height() - 10.0},
                is_heat ? fmt::format("{}; {}", value_title(data.choice), note(data)) : note(data), 10.0, axis_soft);
    return figure;
}

}  // namespace tactus::report
