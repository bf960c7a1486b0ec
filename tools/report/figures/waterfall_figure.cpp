// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/waterfall_figure.hpp"

#include "dsp/core/readable.hpp"
#include "tools/analysis/vibration/level_reference.hpp"
#include "tools/report/figures/axes.hpp"
#include "tools/report/figures/heat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::report {

namespace {

/// Places of the panels of a channel.
struct Layout {
    Layout(const FigureStyle& s, bool has_rate)
        : style(s),
          height(s.height(340.0)),
          each(height + s.gap(60.0)),
          scale(s.gap(60.0)),
          gap(s.gap(50.0)),
          rate_width(has_rate ? 0.17 * s.panel_width() : 0.0),
          width(s.panel_width() - scale - (has_rate ? gap + rate_width : 0.0)) {}

    const FigureStyle& style;
    double height, each, scale, gap, rate_width, width;  ///< scale: of the colours, at the right
    double top() const { return style.gap(62.0); }
};

constexpr FigureStyle wide_screen{904.0, 70.0, 30.0, 10.0, 11.0, 15.0, 1.0};
constexpr double depth = 60.0;  // dB
constexpr display::Colour order_ink{0xC8, 0xCC, 0xD2};
constexpr std::size_t max_rows = 150, max_columns = 220;  // cells of a picture

double place(const analysis::Waterfall& w, std::size_t row) {
    return w.settings.against_speed ? w.rows[row].rate : w.rows[row].time;
}

/// Edges of the rows: halfway between their places.
std::vector<double> edges_of(const analysis::Waterfall& w) {
    const std::size_t rows = w.rows.size();
    if (rows == 1) return {place(w, 0) - 0.5, place(w, 0) + 0.5};
    std::vector<double> edges{place(w, 0) - 0.5 * (place(w, 1) - place(w, 0))};
    for (std::size_t i = 1; i < rows; ++i) edges.push_back(0.5 * (place(w, i - 1) + place(w, i)));
    edges.push_back(place(w, rows - 1) + 0.5 * (place(w, rows - 1) - place(w, rows - 2)));
    return edges;
}

/// The strongest level of the rows and columns of a cell, dB; NaN: none.
class Cells {
public:
    Cells(const analysis::Waterfall& w, const analysis::LevelReference& reference)
        : across(std::min(w.rows.front().rms.size(), max_columns)),
          up(std::min(w.rows.size(), max_rows)),
          waterfall_(w) {
        for (std::size_t r = 0; r < up; ++r)
            for (std::size_t c = 0; c < across; ++c) {
                float best = std::numeric_limits<float>::quiet_NaN();
                for (std::size_t i = row(r); i < row(r + 1); ++i)
                    for (std::size_t k = column(c); k < column(c + 1); ++k) best = std::fmax(best, w.rows[i].rms[k]);
                const auto value = static_cast<double>(best);
                levels_.push_back(std::isnan(best) ? std::nan("") : reference.db(value * value));
                if (!std::isnan(best)) top = std::max(top, levels_.back());
            }
    }
    std::size_t row(std::size_t r) const { return r * waterfall_.rows.size() / up; }
    std::size_t column(std::size_t c) const { return c * waterfall_.rows.front().rms.size() / across; }
    /// The shade, −1: none.
    int shade(std::size_t r, std::size_t c) const {
        const double level = levels_[r * across + c];
        return std::isnan(level) ? -1 : heat_shade((level - top + depth) / depth);
    }

    std::size_t across, up;
    double top = -400.0;  ///< dB

private:
    const analysis::Waterfall& waterfall_;
    std::vector<double> levels_;
};

void draw_cells(display::Figure& figure, const Axes& axes, const analysis::Waterfall& w, const Cells& cells) {
    const std::vector<double> edges = edges_of(w);
    figure.clip(axes.x, axes.y, axes.width, axes.height);
    for (std::size_t r = 0; r < cells.up; ++r) {
        const double low = axes.at(0.0, edges[cells.row(r)]).y, high = axes.at(0.0, edges[cells.row(r + 1)]).y;
        for (std::size_t c = 0; c < cells.across;) {
            std::size_t end = c + 1;
            while (end < cells.across && cells.shade(r, end) == cells.shade(r, c)) ++end;
            // A column is as wide as the distance between columns, its value in the middle.
            const auto edge = [&](std::size_t column) {
                return axes.at((static_cast<double>(cells.column(column)) - 0.5) * w.step, 0.0).x;
            };
            if (const int shade = cells.shade(r, c); shade >= 0)
                figure.rectangle(edge(c), high - 0.2, edge(end) - edge(c) + (end < cells.across ? 0.4 : 0.0),
                                 low - high + 0.4, heat_of_shade(shade));
            c = end;
        }
    }
    figure.unclip();
}

/// Lines of the orders over frequency, which make rows of one rate each a Campbell diagram: a resonance stands upright,
/// an order runs along its line. The lines are broken, so that the levels show between.
void draw_orders(display::Figure& figure, const Axes& axes, const analysis::Waterfall& w, int highest) {
    const double text = 0.9 * axes.style.text;
    figure.clip(axes.x, axes.y, axes.width, axes.height);
    for (int order = 1; order <= highest; ++order) {
        std::vector<display::FigurePoint> line;
        for (std::size_t row = 0; row < w.rows.size(); ++row)
            if (order * w.rows[row].rate <= axes.across.high)
                line.push_back(axes.at(order * w.rows[row].rate, place(w, row)));
        if (line.size() < 2) break;
        figure.line(line, order_ink, 0.8, 3.0);
    }
    figure.unclip();
    // Names at the upper end, where the lines are furthest apart.
    double taken = axes.x;
    for (int order = 1; order <= highest; ++order) {
        const double hz = order * w.rows.back().rate;
        if (hz > axes.across.high) break;
        const double x = axes.at(hz, 0.0).x;
        if (x < taken + 2.4 * text) continue;
        figure.text({x - 3.0, axes.y + 1.2 * text}, fmt::format("×{}", order), std::max(text, journal_style.text),
                    order_ink, display::TextAnchor::end);
        taken = x;
    }
}

void draw_channel(display::Figure& figure, const analysis::OrdersOfChannel& channel, const analysis::Orders& orders,
                  const Layout& layout, double y) {
    const double left = layout.style.left, width = layout.width, height = layout.height;
    const analysis::Waterfall& w = *channel.waterfall;
    const analysis::LevelReference reference = analysis::level_reference(orders.calibration);
    const Cells cells(w, reference);
    const std::vector<double> edges = edges_of(w);
    const double end = static_cast<double>(w.rows.front().rms.size() - 1) * w.step;
    const bool speed = w.settings.against_speed;
    const Scale up{edges.front(), edges.back(), false};
    const Axes axes{figure, left,        y,
                    width,  height,      {0.0, end, false, w.settings.of_orders && end < 21.0 ? 1.0 : 0.0},
                    up,     layout.style};
    axes.draw(fmt::format("channel {}: rms, dB re {}", channel.name, reference.text),
              w.settings.of_orders ? "order" : "frequency, Hz", speed ? "rate, Hz" : "time, s");
    draw_cells(figure, axes, w, cells);
    if (!w.settings.of_orders) draw_orders(figure, axes, w, static_cast<int>(channel.spectrum.orders.size()));
    // The ticks again, over the colours.
    for (const double v : axes.across.ticks())
        figure.line({{axes.at(v, up.low).x, y + height}, {axes.at(v, up.low).x, y + height - 4.0}}, axis_ink, 1.0);
    double scale_at = left + width + layout.style.gap(14.0);
    if (!speed) {
        std::vector<display::FigurePoint> rates;
        double lowest = 1e300, highest = 0.0;
        for (const analysis::WaterfallRow& row : w.rows) {
            rates.push_back({row.rate, row.time});
            lowest = std::min(lowest, row.rate);
            highest = std::max(highest, row.rate);
        }
        const double margin = std::max(0.05 * (highest - lowest), 0.01 * highest);
        const Axes beside{figure, left + width + layout.gap,
                          y,      layout.rate_width,
                          height, {lowest - margin, highest + margin, false},
                          up,     layout.style};
        beside.draw("rate", "Hz", "");
        beside.curve(rates, curve_colours[0], 0.0, false);
        scale_at += layout.gap + layout.rate_width;
    }
    draw_heat_scale(figure, scale_at, y, height, cells.top - depth, cells.top, layout.style.text);
}

}  // namespace

display::Figure draw_waterfall(const analysis::Orders& orders, const std::filesystem::path& file,
                               const FigureStyle& given) {
    const std::size_t shown = std::min<std::size_t>(orders.channels.size(), 4);
    const FigureStyle& style = given.width == screen_style.width ? wide_screen : given;
    const Layout layout(style, !orders.channels.front().waterfall->settings.against_speed);
    display::Figure figure(style.width, layout.top() + layout.each * static_cast<double>(shown));
    figure.text({style.left, style.gap(22.0)}, file.filename().string(), style.heading, axis_ink,
                display::TextAnchor::start, true);
    figure.text({style.left, style.gap(37.0)},
                fmt::format("{}, {} to {}; {}", orders.source, readable(orders.rate.low, "Hz", 4),
                            readable(orders.rate.high, "Hz", 4),
                            orders.stretch.is_whole() ? readable(orders.duration, "s", 4) : orders.stretch.text()),
                style.text, axis_soft);
    for (std::size_t i = 0; i < shown; ++i)
        draw_channel(figure, orders.channels[i], orders, layout, layout.top() + layout.each * static_cast<double>(i));
    return figure;
}

}  // namespace tactus::report
