// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/spectrum_figure.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/readable.hpp"
#include "tools/report/figures/spectrogram_panel.hpp"
#include "tools/report/figures/spectrum_panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::report {

namespace {

constexpr display::Colour curve_colour{0x1F, 0x4E, 0x9E}, order_colour{0xB8, 0x1D, 0x24}, hum_colour{0x1B, 0x7A, 0x3D},
    ink{0x22, 0x26, 0x2E}, soft{0x6B, 0x72, 0x80};
constexpr double left = 70.0, width = 640.0, spectrum_height = 240.0, picture_height = 170.0, envelope_height = 150.0,
                 gap = 44.0, right = 86.0;

/// Names of hum and orders at their lines.
void name_lines(display::Figure& figure, const signal::VibrationReport& r, const SpectrumCurve& curve,
                const DrawnSpectra& drawn, const MarkedArea& area) {
    double taken = -1e9;
    const auto name = [&](double hz, const std::string& text, display::Colour colour) {
        if (hz < area.lowest || hz > area.highest || level_at(curve, hz) < drawn.lowest) return;
        const double x = drawn.panel.x_of(hz), at = drawn.panel.y_of(level_at(curve, hz)) - 4.0;
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
}

std::string about(const analysis::AnalysedChannel& channel, const analysis::AnalysedFile& file) {
    const signal::VibrationReport& r = channel.report;
    return fmt::format("channel {}: rms {}{}; {}", channel.name, readable(r.level.rms(), file.calibration.unit),
                       file.calibration.known ? "" : " (uncalibrated)",
                       r.fundamental.frequency > 0.0 ? fmt::format("fundamental {:.2f} Hz, confidence {:.2f}",
                                                                   r.fundamental.frequency, r.fundamental.confidence)
                                                     : std::string("no fundamental"));
}

/// Draws a channel from `y` on.
void draw_channel(display::Figure& figure, const analysis::AnalysedChannel& channel, const analysis::AnalysedFile& file,
                  double y, std::pair<double, double> range) {
    const signal::VibrationReport& r = channel.report;
    const analysis::LevelReference reference = analysis::level_reference(file.calibration);
    const SpectrumCurve curve{&r.psd, reference, curve_colour};
    const MarkedArea area{left, y, width, spectrum_height, range.first, range.second};
    const DrawnSpectra drawn = draw_spectra(figure, area, std::span(&curve, 1), level_unit(file), file.marks);
    name_lines(figure, r, curve, drawn, area);
    figure.text({left, y - 8.0}, about(channel, file), 11.0, ink);
    figure.text({left + width, y + spectrum_height + 28.0}, "frequency, Hz", 11.0, ink, display::TextAnchor::end);
    y += spectrum_height + gap;
    if (r.spectrogram) {
        draw_spectrogram(
            figure, *r.spectrogram, {left, y, width, picture_height},
            {.lowest = range.first, .highest = range.second, .begin = file.stretch.from, .reference = reference.value});
        y += picture_height + gap + 14.0;
    }
    if (!r.envelope_spectrum || r.envelope_spectrum->power.size() < 8) return;
    const SpectrumCurve envelope{&*r.envelope_spectrum, reference, curve_colour};
    draw_envelopes(figure, {left, y, width, envelope_height, 0.0, end_of_envelope(*file.envelope, file.marks)},
                   std::span(&envelope, 1),
                   fmt::format("envelope of {} to {}", readable(file.envelope->first, "Hz"),
                               readable(file.envelope->second, "Hz")),
                   "dB re (" + reference.text + ")²/Hz", file.marks);
}

}  // namespace

std::string level_unit(const analysis::AnalysedFile& file) {
    return fmt::format("dB re ({})²{}", analysis::level_reference(file.calibration).text, file.is_density ? "/Hz" : "");
}

std::pair<double, double> plotted_range(const PlottedBand& band, double rate) {
    const double nyquist = 0.5 * rate;
    if (!band) return {std::min(20.0, nyquist / 20.0), nyquist};
    if (band->first >= nyquist)
        throw Error(fmt::format("--band {}:{} Hz: the record ends at {}", plain(band->first, 6), plain(band->second, 6),
                                readable(nyquist, "Hz", 6)));
    return *band;
}

display::Figure draw_spectrum(const analysis::AnalysedFile& file, const PlottedBand& band) {
    const std::size_t shown = std::min<std::size_t>(file.channels.size(), 4);
    double each = spectrum_height + gap;
    if (shown > 0 && file.channels.front().report.spectrogram) each += picture_height + gap + 14.0;
    if (file.envelope) each += envelope_height + gap + 24.0;
    display::Figure figure(left + width + right, 60.0 + each * static_cast<double>(shown));
    figure.text({left, 24.0}, file.file.filename().string(), 15.0, ink, display::TextAnchor::start, true);
    const signal::Spectrum* psd = shown > 0 ? &file.channels.front().report.psd : nullptr;
    figure.text({left + width, 24.0},
                psd ? fmt::format("{} at {}; Welch, {} segments, bandwidth {}",
                                  file.stretch.is_whole() ? readable(file.duration, "s", 4) : file.stretch.text(),
                                  readable(file.rate, "Hz", 6), psd->segments, readable(psd->noise_bandwidth, "Hz"))
                    : std::string(),
                10.0, soft, display::TextAnchor::end);
    const std::pair<double, double> range = plotted_range(band, file.rate);
    for (std::size_t i = 0; i < shown; ++i) {
        const double y = 60.0 + each * static_cast<double>(i);
        if (file.channels[i].report.psd.power.size() < 8)
            figure.text({left, y + 20.0}, "too short for a spectrum", 12.0, soft);
        else draw_channel(figure, file.channels[i], file, y, range);
    }
    return figure;
}

}  // namespace tactus::report
