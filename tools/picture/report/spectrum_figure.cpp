// SPDX-License-Identifier: Apache-2.0
#include "tools/picture/report/spectrum_figure.hpp"

#include "tools/picture/report/plot_panel.hpp"
#include "tools/picture/report/spectrogram_panel.hpp"
#include "tools/study/vibration/level_reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::picture {

namespace {

constexpr display::Colour curve_colour{0x1F, 0x4E, 0x9E}, order_colour{0xB8, 0x1D, 0x24}, hum_colour{0x1B, 0x7A, 0x3D},
    ink{0x22, 0x26, 0x2E}, soft{0x6B, 0x72, 0x80}, limit_colour{0x8A, 0x8F, 0x99};
constexpr double left = 70.0, width = 640.0, spectrum_height = 240.0, picture_height = 170.0, gap = 44.0, right = 86.0;
constexpr double decades_down = 80.0;  // dB shown below the strongest

void draw_curve(display::Figure& figure, const study::AnalysedChannel& channel, const study::AnalysedFile& file,
                double y, double lowest, double highest) {
    const signal::VibrationReport& r = channel.report;
    const signal::Spectrum& psd = r.psd;
    const study::LevelReference reference = study::level_reference(file.calibration);
    std::vector<double> levels;
    double top = -400.0;
    for (std::size_t k = 0; k < psd.power.size(); ++k) {
        levels.push_back(reference.db(psd.power[k]));
        if (psd.frequency(k) >= lowest && psd.frequency(k) <= highest) top = std::max(top, levels.back());
    }
    top = 10.0 * std::ceil(top / 10.0) + 10.0;
    const PlotPanel panel(figure, left, y, width, spectrum_height, {lowest, highest}, {top - decades_down, top});
    panel.axes(10.0, fmt::format("dB re ({})²/Hz", reference.text), true);
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
    const auto name = [&](double hz, const std::string& text, display::Colour colour) {
        if (hz < lowest || hz > highest || level_at(hz) < top - decades_down) return;
        const double x = panel.x_of(hz), at = panel.y_of(level_at(hz)) - 4.0;
        figure.fill({{x, at}, {x - 3.5, at - 6.0}, {x + 3.5, at - 6.0}}, colour);
        if (x < taken + 30.0) return;
        figure.text({x, at - 9.0}, text, 10.0, colour, display::TextAnchor::middle);
        taken = x;
    };
    for (const signal::HumLine& h : r.hum) name(h.frequency, fmt::format("{:.1f} hum", h.frequency), hum_colour);
    taken = -1e9;
    for (const signal::Harmonic& h : r.harmonics)
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
    figure.text({left + width, y + spectrum_height + 28.0}, "frequency, Hz", 11.0, ink, display::TextAnchor::end);
}

}  // namespace

display::Figure draw_spectrum(const study::AnalysedFile& file) {
    const std::size_t shown = std::min<std::size_t>(file.channels.size(), 4);
    const double each = spectrum_height + gap + picture_height + gap + 14.0;
    display::Figure figure(left + width + right, 60.0 + each * static_cast<double>(shown));
    figure.text({left, 24.0}, file.file.filename().string(), 15.0, ink, display::TextAnchor::start, true);
    const signal::Spectrum* psd = shown > 0 ? &file.channels.front().report.psd : nullptr;
    figure.text({left + width, 24.0},
                psd ? fmt::format("{:.4g} s at {:.6g} Hz; Welch, {} segments, bandwidth {:.3g} Hz", file.duration,
                                  file.rate, psd->segments, psd->noise_bandwidth)
                    : std::string(),
                10.0, soft, display::TextAnchor::end);
    const double highest = std::min(0.5 * file.rate, 5000.0), lowest = std::min(20.0, highest / 20.0);
    for (std::size_t i = 0; i < shown; ++i) {
        const double y = 60.0 + each * static_cast<double>(i);
        if (file.channels[i].report.psd.power.size() < 8) {
            figure.text({left, y + 20.0}, "too short for a spectrum", 12.0, soft);
            continue;
        }
        draw_curve(figure, file.channels[i], file, y, lowest, highest);
        if (file.channels[i].report.spectrogram)
            draw_spectrogram(figure, *file.channels[i].report.spectrogram,
                             {left, y + spectrum_height + gap, width, picture_height}, {lowest, highest});
    }
    return figure;
}

}  // namespace tactus::picture
