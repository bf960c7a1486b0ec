// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/spectrogram_panel.hpp"

#include "dsp/core/readable.hpp"
#include "dsp/signal/spectrum/decibels.hpp"
#include "tools/report/figures/axes.hpp"
#include "tools/report/figures/heat.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace tactus::report {

namespace {

constexpr display::Colour ink{0x22, 0x26, 0x2E};

}  // namespace

void draw_spectrogram(display::Figure& figure, const signal::Spectrogram& s, const SpectrogramPlace& place,
                      const SpectrogramStyle& style) {
    const double left = place.x, y = place.y, width = place.width, picture_height = place.height;
    const double lowest = style.lowest, highest = style.highest;
    const int rows = style.rows, max_columns = style.columns;
    const int columns = std::min(static_cast<int>(s.columns()), max_columns);
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
            const double db = signal::decibels(power);
            level[static_cast<std::size_t>(c * rows + row)] = db;
            top = std::max(top, db);
        }
    }
    constexpr double span = 60.0;
    const auto shade = [&](int c, int row) {
        const double share = (level[static_cast<std::size_t>(c * rows + row)] - top + span) / span;
        return heat_shade(share);
    };
    std::vector<std::uint8_t> cells;
    for (int row = rows - 1; row >= 0; --row)
        for (int c = 0; c < columns; ++c) cells.push_back(static_cast<std::uint8_t>(shade(c, row)));
    std::vector<display::Colour> palette;
    for (int i = 0; i < heat_shades; ++i) palette.push_back(heat_of_shade(i));
    figure.cells(left, y, width, picture_height, columns, rows, std::move(cells), std::move(palette));
    const double bottom = y + picture_height, duration = s.column_seconds() * static_cast<double>(s.columns());
    for (const double hz : Scale{lowest, highest, true}.ticks()) {
        const double at = bottom - picture_height * std::log(hz / lowest) / std::log(highest / lowest);
        figure.line({{left - 4.0, at}, {left, at}}, ink, 1.0);
        figure.text({left - 6.0, at + 4.0}, axis_number(hz), 11.0, ink, display::TextAnchor::end);
    }
    const double step = std::pow(10.0, std::floor(std::log10(duration / 2.0)));
    const double tick = duration / step > 10.0 ? 5.0 * step : duration / step > 5.0 ? 2.0 * step : step;
    for (double t = std::ceil(style.begin / tick - 1e-9) * tick; t <= style.begin + duration * 1.0001; t += tick) {
        const double x = left + width * (t - style.begin) / duration;
        figure.line({{x, bottom}, {x, bottom + 4.0}}, ink, 1.0);
        figure.text({x, bottom + 16.0}, plain(t), 11.0, ink, display::TextAnchor::middle);
    }
    figure.line({{left, y}, {left + width, y}, {left + width, bottom}, {left, bottom}, {left, y}}, ink, 1.0);
    figure.text({left - 46.0, y + 0.5 * picture_height}, "Hz", 11.0, ink, display::TextAnchor::middle, false, true);
    figure.text({left + width, bottom + 28.0}, "time, s", 11.0, ink, display::TextAnchor::end);
    if (!style.legend) return;
    const double shown_top = style.relative ? 0.0 : top - 20.0 * std::log10(style.reference);
    draw_heat_scale(figure, left + width + 14.0, y, picture_height, shown_top - span, shown_top);
}

}  // namespace tactus::report
