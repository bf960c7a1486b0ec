// SPDX-License-Identifier: Apache-2.0
#include "tools/picture/report/spectrogram_panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace tactus::picture {

namespace {

constexpr display::Colour ink{0x22, 0x26, 0x2E};

double decibels(double power) { return 10.0 * std::log10(std::max(power, 1e-30)); }

/// Colour map from dark violet over green to yellow with uniformly increasing lightness; also correct in grey.
display::Colour heat(double share) {
    constexpr std::array<std::array<double, 3>, 6> stops{
        {{68, 1, 84}, {65, 68, 135}, {42, 120, 142}, {34, 168, 132}, {122, 209, 81}, {253, 231, 37}}};
    const double at = std::clamp(share, 0.0, 1.0) * (stops.size() - 1);
    const auto i = std::min<std::size_t>(static_cast<std::size_t>(at), stops.size() - 2);
    const auto mix = [&](std::size_t part) {
        return static_cast<std::uint8_t>(stops[i][part] +
                                         (at - static_cast<double>(i)) * (stops[i + 1][part] - stops[i][part]));
    };
    return {mix(0), mix(1), mix(2)};
}

}  // namespace

void draw_spectrogram(display::Figure& figure, const signal::Spectrogram& s, const SpectrogramPlace& place,
                      const SpectrogramStyle& style) {
    const double left = place.x, y = place.y, width = place.width, picture_height = place.height;
    const double lowest = style.lowest, highest = style.highest;
    const int rows = style.rows, most_columns = style.columns;
    const int columns = std::min(static_cast<int>(s.columns()), most_columns);
    if (columns == 0) return;
    // The maximum in each cell of the picture.
    std::vector<double> level(static_cast<std::size_t>(columns * rows), -300.0);
    double top = -300.0;
    for (int c = 0; c < columns; ++c) {
        const std::size_t from = s.columns() * static_cast<std::size_t>(c) / static_cast<std::size_t>(columns);
        const std::size_t to = s.columns() * static_cast<std::size_t>(c + 1) / static_cast<std::size_t>(columns);
        for (int row = 0; row < rows; ++row) {
            const double low = lowest * std::pow(highest / lowest, static_cast<double>(row) / rows);
            const double high = lowest * std::pow(highest / lowest, static_cast<double>(row + 1) / rows);
            const auto k0 = static_cast<std::size_t>(std::lround(low / s.df()));
            const auto k1 = std::max(k0, static_cast<std::size_t>(std::lround(high / s.df())));
            double power = 0.0;
            for (std::size_t i = from; i < to; ++i)
                for (std::size_t k = k0; k <= k1 && k < s.bins(); ++k)
                    power = std::max(power, static_cast<double>(s.column(i)[k]));
            const double db = decibels(power);
            level[static_cast<std::size_t>(c * rows + row)] = db;
            top = std::max(top, db);
        }
    }
    constexpr int shades = 24;
    constexpr double span = 60.0;
    const auto shade = [&](int c, int row) {
        const double share = (level[static_cast<std::size_t>(c * rows + row)] - top + span) / span;
        return static_cast<int>(std::clamp(share, 0.0, 1.0) * (shades - 1) + 0.5);
    };
    std::vector<std::uint8_t> cells;
    for (int row = rows - 1; row >= 0; --row)
        for (int c = 0; c < columns; ++c) cells.push_back(static_cast<std::uint8_t>(shade(c, row)));
    std::vector<display::Colour> palette;
    for (int i = 0; i < shades; ++i) palette.push_back(heat(static_cast<double>(i) / (shades - 1)));
    figure.cells(left, y, width, picture_height, columns, rows, std::move(cells), std::move(palette));
    const double bottom = y + picture_height, duration = s.column_seconds() * static_cast<double>(s.columns());
    for (const double hz : {10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0, 10000.0}) {
        if (hz < lowest || hz > highest) continue;
        const double at = bottom - picture_height * std::log(hz / lowest) / std::log(highest / lowest);
        figure.line({{left - 4.0, at}, {left, at}}, ink, 1.0);
        figure.text({left - 6.0, at + 4.0}, fmt::format("{:g}", hz), 11.0, ink, display::TextAnchor::end);
    }
    const double step = std::pow(10.0, std::floor(std::log10(duration / 2.0)));
    const double tick = duration / step > 10.0 ? 5.0 * step : duration / step > 5.0 ? 2.0 * step : step;
    for (double t = 0.0; t <= duration * 1.0001; t += tick) {
        const double x = left + width * t / duration;
        figure.line({{x, bottom}, {x, bottom + 4.0}}, ink, 1.0);
        figure.text({x, bottom + 16.0}, fmt::format("{:g}", t), 11.0, ink, display::TextAnchor::middle);
    }
    figure.line({{left, y}, {left + width, y}, {left + width, bottom}, {left, bottom}, {left, y}}, ink, 1.0);
    figure.text({left - 46.0, y + 0.5 * picture_height}, "Hz", 11.0, ink, display::TextAnchor::middle, false, true);
    figure.text({left + width, bottom + 28.0}, "time, s", 11.0, ink, display::TextAnchor::end);
    if (!style.legend) return;
    for (int i = 0; i < shades; ++i)
        figure.rectangle(left + width + 14.0, bottom - picture_height * (i + 1) / shades, 12.0,
                         picture_height / shades + 0.4, heat(static_cast<double>(i) / (shades - 1)));
    for (int i = 0; i <= 3; ++i)
        figure.text({left + width + 30.0, bottom - picture_height * i / 3.0 + 4.0},
                    fmt::format("{:.0f} dB", (style.relative ? 0.0 : top) - span + 20.0 * i), 10.0, ink);
}

}  // namespace tactus::picture
