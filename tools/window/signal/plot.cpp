// SPDX-License-Identifier: Apache-2.0
#include "tools/window/signal/plot.hpp"

#include "assets/sound/record_reader.hpp"
#include "tools/window/signal/readings.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::window {

namespace {

double db(double power) { return power > 0.0 ? std::max(10.0 * std::log10(power), lowest_db) : lowest_db; }

Curve curve_of(const signal::Spectrum& spectrum, const std::string& name, std::uint32_t ink, Range hz,
               double shift_db) {
    Curve curve{name, ink, {}};
    // When bins are closer than a pixel, the maximum in each of 600 equal frequency steps.
    constexpr double steps = 600.0;
    double last = -1.0;
    for (std::size_t k = 1; k < spectrum.power.size(); ++k) {
        const double f = spectrum.frequency(k);
        if (f < hz.low || f > hz.high) continue;
        const double step = std::floor(steps * std::log(f / hz.low) / std::log(hz.high / hz.low));
        const double level = db(spectrum.power[k]) + shift_db;
        // The frequency of the largest bin, not of the step: a tone is read where it is.
        if (step != last) curve.points.push_back({f, level});
        else if (level > curve.points.back().y) curve.points.back() = {f, level};
        last = step;
    }
    return curve;
}

std::string name_of(const Trace& trace, std::size_t column) {
    return column < trace.names.size() ? trace.names[column] : "";
}

double power_between(const signal::Spectrum& spectrum, Range hz) {
    double sum = 0.0;
    for (std::size_t k = 1; k < spectrum.power.size(); ++k)
        if (spectrum.frequency(k) >= hz.low && spectrum.frequency(k) <= hz.high) sum += spectrum.power[k] * spectrum.df;
    return sum;
}

std::string density_unit(const Display& display) {
    return display.unit.empty() ? "dB/Hz" : fmt::format("dB re ({})²/Hz", display.unit);
}

display::Colour figure_colour(std::uint32_t ink) {
    // The window's colours are designed for a dark background.
    const auto part = [&](int shift) { return static_cast<std::uint8_t>((ink >> shift & 0xFF) * 7 / 10); };
    return {part(0), part(8), part(16), 1.0};
}

}  // namespace

std::vector<std::span<const Point>> pieces_of(const Curve& curve) {
    const std::span<const Point> all(curve.points);
    std::vector<std::span<const Point>> pieces;
    std::size_t from = 0;
    for (const std::size_t begin : curve.begins) {
        pieces.push_back(all.subspan(from, begin - from));
        from = begin;
    }
    pieces.push_back(all.subspan(from));
    std::erase_if(pieces, [](const auto& piece) { return piece.empty(); });
    return pieces;
}

double Plot::across(double value) const {
    if (is_logarithmic) return std::log(std::max(value, 1e-12) / x.low) / std::log(x.high / x.low);
    return (value - x.low) / x.span();
}

double Plot::up(double value) const { return (value - y.low) / y.span(); }

double Plot::value_at(double share) const {
    return is_logarithmic ? x.low * std::pow(x.high / x.low, share) : x.low + share * x.span();
}

Display display_of(const ValueType& type, const std::string& unit) {
    if (&type == &value::pose) return {1e3, "mm", 3};
    if (&type == &value::twist) return {1e3, "mm/s", 3};
    if (&type == &value::wrench) return {1.0, "N", 3};
    if (&type == &value::vector) return unit == "m" ? Display{1e3, "mm", 3} : Display{1.0, unit, 3};
    return {1.0, unit, 1};
}

std::vector<std::string> column_units(const ValueType& type, const std::string& unit) {
    if (&type == &value::pose) return {"m", "m", "m", "", "", "", ""};
    if (&type == &value::twist) return {"m/s", "m/s", "m/s", "rad/s", "rad/s", "rad/s"};
    if (&type == &value::wrench) return {"N", "N", "N", "N m", "N m", "N m"};
    return std::vector<std::string>(std::max<std::size_t>(type.columns.size(), 1), unit);
}

Plot time_plot(const Trace& trace, const Display& display, double now, double span, int pixels, double origin) {
    Plot plot;
    const Range time{now - span, now};
    plot.x = {time.low - origin, time.high - origin};
    plot.origin = origin;
    plot.x_unit = "s";
    plot.y_unit = display.unit;
    Range values{1e300, -1e300};
    const std::size_t shown = std::min(display.columns, trace.columns.size());
    const std::size_t first = index_at(trace, time.low);
    std::size_t past = first;
    while (past < trace.times.size() && trace.times[past] <= time.high) ++past;
    const std::size_t count = past - first;
    for (std::size_t c = 0; c < shown; ++c) {
        Curve curve{c < trace.names.size() ? trace.names[c] : "", tone::curves[c % std::size(tone::curves)], {}};
        const auto add = [&](double at, double value) {
            curve.points.push_back({at - origin, value});
            values = {std::min(values.low, value), std::max(values.high, value)};
        };
        const auto begin_piece = [&] {
            if (!curve.points.empty()) curve.begins.push_back(curve.points.size());
        };
        if (count <= 2 * static_cast<std::size_t>(std::max(pixels, 1))) {
            bool is_broken = false;
            for (std::size_t i = first; i < past; ++i) {
                const double value = trace.columns[c][i] * display.factor;
                is_broken |= follows_gap(trace, i) || !std::isfinite(value);
                if (!std::isfinite(value)) continue;
                if (std::exchange(is_broken, false)) begin_piece();
                add(trace.times[i], value);
            }
        } else {
            const Envelope envelope = envelope_of(trace.times, trace.columns[c], time, pixels, trace.period);
            for (int k = 0; k < pixels; ++k) {
                const auto at = static_cast<std::size_t>(k);
                if (std::isnan(envelope.low[at])) continue;
                if (envelope.begins[at]) begin_piece();
                const double middle = time.low + (k + 0.5) / pixels * span;
                add(middle, envelope.low[at] * display.factor);
                add(middle, envelope.high[at] * display.factor);
            }
        }
        if (count > 0) curve.last = trace.columns[c][past - 1] * display.factor;
        plot.curves.push_back(std::move(curve));
    }
    plot.y = fitted({0.0, 0.0}, values.high >= values.low ? values : Range{-1.0, 1.0});
    return plot;
}

Plot spectrum_plot(const Trace& trace, std::size_t column, const Display& display, double rate, double now, double span,
                   const signal::Spectrum& reference) {
    Plot plot;
    plot.is_logarithmic = true;
    plot.x_unit = "Hz";
    plot.y_unit = plot.level_unit = density_unit(display);
    const signal::Spectrum spectrum = spectrum_of(trace, column, rate, {now - span, now}, display.factor);
    // From the first bin on.
    plot.x = {spectrum.power.size() > 1 ? spectrum.df : std::max(10.0, 2.0 / span), 0.5 * rate};
    if (plot.x.high <= 2.0 * plot.x.low) plot.x.low = 0.05 * rate;
    if (spectrum.power.size() < 2) plot.note = "too few values for a spectrum";
    if (!reference.power.empty()) {
        const Range both{plot.x.low, std::min(plot.x.high, reference.frequency(reference.power.size() - 1))};
        const double mine = power_between(spectrum, both), its = power_between(reference, both);
        const double shift = mine > 0.0 && its > 0.0 ? 10.0 * std::log10(mine / its) : 0.0;
        plot.curves.push_back(curve_of(reference, "reference, at the same power", colour(0x64748b), plot.x, shift));
        plot.curves.back().is_reference = true;
    }
    plot.curves.push_back(curve_of(spectrum, name_of(trace, column), tone::curves[0], plot.x, 0.0));
    fit_levels(plot);
    return plot;
}

void fit_levels(Plot& plot) {
    double largest = lowest_db;
    for (const Curve& curve : plot.curves)
        for (const Point& p : curve.points) largest = std::max(largest, p.y);
    if (largest <= lowest_db) largest = 0.0;
    const double top = 10.0 * std::ceil((largest + 3.0) / 10.0);
    plot.y = {top - 90.0, top};
}

Plot histogram_plot(const Trace& trace, std::size_t column, const Display& display, double now, double span) {
    constexpr int parts = 60;
    Plot plot;
    plot.x_unit = display.unit;
    plot.y_unit = "%";
    Curve curve{name_of(trace, column), tone::curves[0], {}};
    const Histogram histogram = histogram_of(trace, column, {now - span, now}, parts);
    double most = 0.0;
    for (std::size_t k = 0; k < histogram.counts.size(); ++k) {
        const double percent = 100.0 * static_cast<double>(histogram.counts[k]) / static_cast<double>(histogram.total);
        const double wide = histogram.values.span() / parts;
        const double left = histogram.values.low + static_cast<double>(k) * wide;
        for (const Point p : {Point{left, 0.0}, {left, percent}, {left + wide, percent}, {left + wide, 0.0}})
            curve.points.push_back({p.x * display.factor, p.y});
        most = std::max(most, percent);
    }
    const Range values{histogram.values.low * display.factor, histogram.values.high * display.factor};
    plot.x = fitted({0.0, 0.0}, values);
    plot.y = {0.0, most > 0.0 ? 1.08 * most : 1.0};
    plot.curves.push_back(std::move(curve));
    return plot;
}

Plot xy_plot(const Trace& x, std::size_t x_column, const Display& x_display, const Trace& y, std::size_t y_column,
             const Display& y_display, double now, double span) {
    constexpr std::size_t most = 4000;
    Plot plot;
    plot.x_unit = x_display.unit;
    plot.y_unit = y_display.unit;
    Curve curve{name_of(y, y_column), tone::curves[0], {}};
    Range across{1e300, -1e300}, up = across;
    Pairs pairs = pairs_of(x, x_column, y, y_column, {now - span, now}, most);
    if (pairs.is_cut) plot.note = fmt::format("last {}", span_words(now - pairs.since));
    curve.begins = std::move(pairs.begins);
    for (const Point& p : pairs.points) {
        const Point at{p.x * x_display.factor, p.y * y_display.factor};
        curve.points.push_back(at);
        across = {std::min(across.low, at.x), std::max(across.high, at.x)};
        up = {std::min(up.low, at.y), std::max(up.high, at.y)};
    }
    const bool is_empty = curve.points.empty();
    if (!is_empty) curve.last = curve.points.back().y;
    plot.x = fitted({0.0, 0.0}, is_empty ? Range{-1.0, 1.0} : across);
    plot.y = fitted({0.0, 0.0}, is_empty ? Range{-1.0, 1.0} : up);
    plot.curves.push_back(std::move(curve));
    return plot;
}

Plot waterfall_plot(const Trace& trace, std::size_t column, const Display& display, double rate, double now,
                    double span) {
    Plot plot;
    plot.is_logarithmic = true;
    plot.waterfall = waterfall_of(trace, column, rate, {now - span, now}, 48, 160, display.factor);
    plot.level_unit = density_unit(display);
    plot.x = plot.waterfall->hz;
    plot.x_unit = "Hz";
    plot.y = {now - span, now};
    plot.y_unit = "s";
    if (std::ranges::none_of(plot.waterfall->bins, [](double hz) { return hz > 0.0; }))
        plot.note = "too few values for a spectrum";
    return plot;
}

double top_of(const Waterfall& waterfall) {
    double largest = lowest_db;
    for (const double level : waterfall.cells) largest = std::max(largest, level);
    return largest <= lowest_db ? 0.0 : 10.0 * std::ceil(largest / 10.0);
}

std::uint32_t waterfall_ink(double level_db, double top_db) {
    // From black over blue and orange to white: brighter is louder, for those who see no colours, too.
    constexpr double stops[][3] = {{13, 17, 24}, {30, 58, 120}, {170, 80, 90}, {250, 170, 60}, {255, 250, 220}};
    const double at = std::clamp((level_db - top_db + 90.0) / 90.0, 0.0, 1.0) * 4.0;
    const auto low = std::min(static_cast<std::size_t>(at), std::size_t{3});
    const auto part = [&](std::size_t c) {
        const double share = at - static_cast<double>(low);
        return static_cast<std::uint32_t>(std::lround(stops[low][c] + share * (stops[low + 1][c] - stops[low][c])));
    };
    return colour(part(0) << 16 | part(1) << 8 | part(2));
}

signal::Spectrum spectrum_of_file(const std::filesystem::path& path) {
    sound::RecordReader reader(path, {}, std::nullopt);
    signal::WelchSettings settings;
    settings.rate = reader.rate();
    settings.segment = signal::suggested_segment(reader.rate(), reader.frames());
    settings.overlap = settings.segment / 2;
    signal::WelchStream<double> stream(settings);
    for (sound::RecordBlock block; reader.next(block);) {
        if (block.after_gap) stream.forget_waiting();
        stream.push(block.channels.front());
    }
    return stream.spectrum();
}

display::Figure figure_of(const Plot& plot, double width, double height) {
    const double left = 64, right = width - 16, top = 34, bottom = height - 40;
    display::Figure figure(width, height);
    figure.text({left, 20}, plot.title, 13, {15, 23, 42}, display::TextAnchor::start, true);
    const display::Colour grid{226, 232, 240}, ink{71, 85, 105};
    const auto x_of = [&](double v) { return left + plot.across(v) * (right - left); };
    const auto y_of = [&](double v) { return bottom - plot.up(v) * (bottom - top); };
    const std::vector<double> across = plot.x_ticks(9), up = linear_ticks(plot.y, 6);
    const double x_step = across.size() > 1 ? across[1] - across[0] : 1.0, y_step = up.size() > 1 ? up[1] - up[0] : 1.0;
    for (const double v : across) {
        figure.line({{x_of(v), top}, {x_of(v), bottom}}, grid, 1);
        figure.text({x_of(v), bottom + 15}, plot.is_logarithmic ? fmt::format("{:g}", v) : tick_label(v, x_step), 10,
                    ink, display::TextAnchor::middle);
    }
    for (const double v : up) {
        figure.line({{left, y_of(v)}, {right, y_of(v)}}, grid, 1);
        figure.text({left - 6, y_of(v) + 3.5}, tick_label(v, y_step), 10, ink, display::TextAnchor::end);
    }
    figure.text({0.5 * (left + right), height - 8}, plot.x_unit, 10, ink, display::TextAnchor::middle);
    figure.text({14, 0.5 * (top + bottom)}, plot.y_unit, 10, ink, display::TextAnchor::middle, false, true);
    figure.clip(left, top, right - left, bottom - top);
    if (plot.waterfall && plot.waterfall->rows > 0) {
        const Waterfall& all = *plot.waterfall;
        const double loudest = top_of(all);
        std::vector<display::Colour> palette;
        for (int k = 0; k < 256; ++k) {
            const std::uint32_t shade = waterfall_ink(loudest - 90.0 + 90.0 * k / 255.0, loudest);
            const auto part = [&](int shift) { return static_cast<std::uint8_t>(shade >> shift & 0xFF); };
            palette.push_back({part(0), part(8), part(16), 1.0});
        }
        std::vector<std::uint8_t> cells;
        for (int row = all.rows; row-- > 0;)
            for (int c = 0; c < all.columns; ++c)
                cells.push_back(static_cast<std::uint8_t>(
                    std::clamp((all.at(row, c) - loudest + 90.0) / 90.0 * 255.0, 0.0, 255.0)));
        figure.cells(left, top, right - left, bottom - top, all.columns, all.rows, std::move(cells),
                     std::move(palette));
    }
    for (const Curve& curve : plot.curves) {
        for (const std::span<const Point> piece : pieces_of(curve)) {
            std::vector<display::FigurePoint> line;
            for (const Point& p : piece) line.push_back({x_of(p.x), y_of(p.y)});
            // A lone value is a dash.
            if (line.size() == 1) line = {{x_of(piece[0].x) - 1.0, line[0].y}, {x_of(piece[0].x) + 1.0, line[0].y}};
            figure.line(std::move(line), figure_colour(curve.ink), 1.2);
        }
    }
    figure.unclip();
    double at = right;
    for (auto curve = plot.curves.rbegin(); curve != plot.curves.rend(); ++curve) {
        figure.text({at, 20}, curve->name, 10, figure_colour(curve->ink), display::TextAnchor::end);
        at -= 12.0 + 6.2 * static_cast<double>(curve->name.size());
    }
    return figure;
}

}  // namespace tactus::window
