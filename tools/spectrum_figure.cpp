// SPDX-License-Identifier: Apache-2.0
#include "tools/spectrum_figure.hpp"

#include "tools/plot_panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus {

namespace {

constexpr Colour curve_colour{0x1F, 0x4E, 0x9E}, order_colour{0xB8, 0x1D, 0x24}, hum_colour{0x1B, 0x7A, 0x3D},
    ink{0x22, 0x26, 0x2E}, soft{0x6B, 0x72, 0x80}, limit_colour{0x8A, 0x8F, 0x99};
constexpr double left = 70.0, width = 640.0, spectrum_height = 240.0, picture_height = 170.0, gap = 44.0, right = 86.0;
constexpr double decades_down = 80.0;  // dB shown below the strongest

/// From dark violet over green to yellow, lightness rising evenly: also right in grey.
Colour heat(double share) {
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

void draw_curve(Figure& figure, const AnalysedChannel& channel, const AnalysedFile& file, double y, double lowest,
                double highest) {
    const VibrationReport& r = channel.report;
    const Spectrum& psd = r.psd;
    std::vector<double> levels;
    double top = -300.0;
    for (std::size_t k = 0; k < psd.power.size(); ++k) {
        levels.push_back(decibels(psd.power[k]));
        if (psd.frequency(k) >= lowest && psd.frequency(k) <= highest) top = std::max(top, levels.back());
    }
    top = 10.0 * std::ceil(top / 10.0) + 10.0;
    const PlotPanel panel(figure, left, y, width, spectrum_height, {lowest, highest}, {top - decades_down, top});
    panel.axes(10.0, fmt::format("dB re 1 ({})²/Hz", file.calibration.unit), true);
    if (highest > 500.0 && lowest < 500.0) {
        panel.upright(500.0, limit_colour, 4.0);
        figure.text({panel.x_of(500.0) + 4.0, y + spectrum_height - 6.0}, "limit of touch", 10.0, soft);
    }
    panel.curve(levels, psd.df, curve_colour, 1.3);
    const auto level_at = [&](double hz) {
        const auto k =
            static_cast<std::size_t>(std::clamp(std::round(hz / psd.df), 1.0, static_cast<double>(levels.size() - 2)));
        return std::max({levels[k - 1], levels[k], levels[k + 1]});
    };
    double taken = -1e9;
    const auto name = [&](double hz, const std::string& text, Colour colour) {
        if (hz < lowest || hz > highest || level_at(hz) < top - decades_down) return;
        const double x = panel.x_of(hz), at = panel.y_of(level_at(hz)) - 4.0;
        figure.fill({{x, at}, {x - 3.5, at - 6.0}, {x + 3.5, at - 6.0}}, colour);
        if (x < taken + 30.0) return;
        figure.text({x, at - 9.0}, text, 10.0, colour, TextAnchor::middle);
        taken = x;
    };
    for (const HumLine& h : r.hum) name(h.frequency, fmt::format("{:.1f} hum", h.frequency), hum_colour);
    taken = -1e9;
    for (const Harmonic& h : r.harmonics)
        if (h.present)
            name(h.frequency, h.order == 1 ? fmt::format("{:.1f} Hz", h.frequency) : fmt::format("×{}", h.order),
                 order_colour);
    figure.text(
        {left, y - 8.0},
        fmt::format("channel {}: rms {:.3g} {}{}; {}", channel.name, r.level.rms(), file.calibration.unit,
                    file.calibration.known ? "" : " (uncalibrated)",
                    r.fundamental.frequency > 0.0 ? fmt::format("fundamental {:.2f} Hz, confidence {:.2f}",
                                                                r.fundamental.frequency, r.fundamental.confidence)
                                                  : std::string("no fundamental")),
        11.0, ink);
    figure.text({left + width, y + spectrum_height + 28.0}, "frequency, Hz", 11.0, ink, TextAnchor::end);
}

void draw_picture(Figure& figure, const Spectrogram& s, double y, double lowest, double highest) {
    constexpr int rows = 110;
    constexpr int most_columns = 320;
    const int columns = static_cast<int>(std::min<std::size_t>(s.columns(), most_columns));
    if (columns == 0) return;
    // The strongest in each row's band and each column's time.
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
    const double w = width / columns, h = picture_height / rows;
    const auto shade = [&](int c, int row) {
        const double share = (level[static_cast<std::size_t>(c * rows + row)] - top + span) / span;
        return static_cast<int>(std::clamp(share, 0.0, 1.0) * (shades - 1) + 0.5);
    };
    // One rectangle for neighbours in time of one shade; a little overlap hides the seams.
    for (int row = 0; row < rows; ++row)
        for (int c = 0; c < columns;) {
            int end = c + 1;
            while (end < columns && shade(end, row) == shade(c, row)) ++end;
            figure.rectangle(left + c * w, y + picture_height - (row + 1) * h,
                             (end - c) * w + (end < columns ? 0.4 : 0.0), h + (row > 0 ? 0.4 : 0.0),
                             heat(static_cast<double>(shade(c, row)) / (shades - 1)));
            c = end;
        }
    const double bottom = y + picture_height, duration = s.column_seconds() * static_cast<double>(s.columns());
    for (const double hz : {10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0, 10000.0}) {
        if (hz < lowest || hz > highest) continue;
        const double at = bottom - picture_height * std::log(hz / lowest) / std::log(highest / lowest);
        figure.line({{left - 4.0, at}, {left, at}}, ink, 1.0);
        figure.text({left - 6.0, at + 4.0}, fmt::format("{:g}", hz), 11.0, ink, TextAnchor::end);
    }
    const double step = std::pow(10.0, std::floor(std::log10(duration / 2.0)));
    const double tick = duration / step > 10.0 ? 5.0 * step : duration / step > 5.0 ? 2.0 * step : step;
    for (double t = 0.0; t <= duration * 1.0001; t += tick) {
        const double x = left + width * t / duration;
        figure.line({{x, bottom}, {x, bottom + 4.0}}, ink, 1.0);
        figure.text({x, bottom + 16.0}, fmt::format("{:g}", t), 11.0, ink, TextAnchor::middle);
    }
    figure.line({{left, y}, {left + width, y}, {left + width, bottom}, {left, bottom}, {left, y}}, ink, 1.0);
    figure.text({left - 46.0, y + 0.5 * picture_height}, "Hz", 11.0, ink, TextAnchor::middle, false, true);
    figure.text({left + width, bottom + 28.0}, "time, s", 11.0, ink, TextAnchor::end);
    for (int i = 0; i < shades; ++i)
        figure.rectangle(left + width + 14.0, bottom - picture_height * (i + 1) / shades, 12.0,
                         picture_height / shades + 0.4, heat(static_cast<double>(i) / (shades - 1)));
    for (int i = 0; i <= 3; ++i)
        figure.text({left + width + 30.0, bottom - picture_height * i / 3.0 + 4.0},
                    fmt::format("{:.0f} dB", top - span + 20.0 * i), 10.0, ink);
}

}  // namespace

Figure draw_spectrum(const AnalysedFile& file) {
    const std::size_t shown = std::min<std::size_t>(file.channels.size(), 4);
    const double each = spectrum_height + gap + picture_height + gap + 14.0;
    Figure figure(left + width + right, 60.0 + each * static_cast<double>(shown));
    figure.text({left, 24.0}, file.file.filename().string(), 15.0, ink, TextAnchor::start, true);
    const Spectrum* psd = shown > 0 ? &file.channels.front().report.psd : nullptr;
    figure.text({left + width, 24.0},
                psd ? fmt::format("{:.4g} s at {:.6g} Hz; Welch, {} segments, bandwidth {:.3g} Hz", file.duration,
                                  file.rate, psd->segments, psd->noise_bandwidth)
                    : std::string(),
                10.0, soft, TextAnchor::end);
    const double highest = std::min(0.5 * file.rate, 5000.0), lowest = std::min(20.0, highest / 20.0);
    for (std::size_t i = 0; i < shown; ++i) {
        const double y = 60.0 + each * static_cast<double>(i);
        if (file.channels[i].report.psd.power.size() < 8) {
            figure.text({left, y + 20.0}, "too short for a spectrum", 12.0, soft);
            continue;
        }
        draw_curve(figure, file.channels[i], file, y, lowest, highest);
        if (file.channels[i].report.spectrogram)
            draw_picture(figure, *file.channels[i].report.spectrogram, y + spectrum_height + gap, lowest, highest);
    }
    return figure;
}

}  // namespace tactus
