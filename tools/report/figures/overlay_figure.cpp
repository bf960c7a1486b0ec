// SPDX-License-Identifier: Apache-2.0
// Several records in one plot.
#include "dsp/core/error.hpp"
#include "dsp/core/readable.hpp"
#include "tools/report/figures/spectrum_figure.hpp"
#include "tools/report/figures/spectrum_panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::report {

namespace {

// Okabe and Ito's colours, without the yellow that white paper swallows: told apart with every kind of colour blindness.
constexpr std::array<display::Colour, 7> colours{{{0x00, 0x72, 0xB2},
                                                  {0xD5, 0x5E, 0x00},
                                                  {0x00, 0x9E, 0x73},
                                                  {0xCC, 0x79, 0xA7},
                                                  {0xE6, 0x9F, 0x00},
                                                  {0x56, 0xB4, 0xE9},
                                                  {0x00, 0x00, 0x00}}};
constexpr display::Colour ink{0x22, 0x26, 0x2E}, soft{0x6B, 0x72, 0x80};
constexpr double left = 70.0, width = 720.0, height = 320.0, envelope_height = 200.0, row = 16.0;
static_assert(max_curves == 2 * colours.size());

struct Shown {
    SpectrumCurve curve;
    const analysis::AnalysedFile* file;
    const analysis::AnalysedChannel* channel;
};

std::vector<Shown> curves_of(std::span<const analysis::AnalysedFile> files) {
    std::vector<Shown> shown;
    for (const analysis::AnalysedFile& file : files) {
        const std::string here = level_unit(file), first = level_unit(files.front());
        if (here != first)
            throw Error(
                fmt::format("{} is in {} and {} in {}: one figure has one unit; state it with --calibration, or "
                            "draw them one by one with a folder for --plot",
                            files.front().file.string(), files.front().calibration.unit, file.file.string(),
                            file.calibration.unit));
        for (const analysis::AnalysedChannel& channel : file.channels)
            if (channel.report.psd.power.size() >= 8)
                shown.push_back(
                    {{&channel.report.psd, analysis::level_reference(file.calibration), {}}, &file, &channel});
    }
    if (shown.empty()) throw Error("no record is long enough for a spectrum");
    if (shown.size() > max_curves)
        throw Error(
            fmt::format("{} channels: one figure holds at most {}; choose with --channel or --column, or draw them "
                        "one by one with a folder for --plot",
                        shown.size(), max_curves));
    for (std::size_t i = 0; i < shown.size(); ++i) {
        shown[i].curve.colour = colours[i % colours.size()];
        shown[i].curve.dash = i < colours.size() ? 0.0 : 4.0;
    }
    return shown;
}

std::string name_of(const Shown& one, std::span<const analysis::AnalysedFile> files) {
    const auto same_name = std::ranges::count_if(
        files, [&](const auto& file) { return file.file.filename() == one.file->file.filename(); });
    std::string name = (same_name > 1 ? one.file->file : one.file->file.filename()).string();
    if (one.file->channels.size() > 1) name += ", channel " + one.channel->name;
    return name;
}

std::string facts_of(const Shown& one) {
    const signal::VibrationReport& r = one.channel->report;
    return fmt::format(
        "rms {}{}, {:.1f} dB; {}bandwidth {}", readable(r.level.rms(), one.file->calibration.unit),
        one.file->calibration.known ? "" : " (uncalibrated)", one.curve.reference.db(r.level.rms() * r.level.rms()),
        one.file->stretch.is_whole() ? "" : one.file->stretch.text() + "; ", readable(r.psd.noise_bandwidth, "Hz"));
}

}  // namespace

display::Figure draw_overlay(std::span<const analysis::AnalysedFile> files, const PlottedBand& band) {
    const std::vector<Shown> shown = curves_of(files);
    double rate = 0.0;
    for (const Shown& one : shown) rate = std::max(rate, one.file->rate);
    const auto [lowest, highest] = plotted_range(band, rate);
    const bool envelopes = files.front().envelope.has_value();
    const double legend = 44.0, top = legend + row * static_cast<double>(shown.size()) + 8.0;
    display::Figure figure(left + width + 30.0, top + height + 44.0 + (envelopes ? envelope_height + 64.0 : 0.0));
    figure.text({left, 24.0}, fmt::format("{} records", files.size()), 15.0, ink, display::TextAnchor::start, true);
    figure.text({left + width, 24.0}, "Welch; rms levels", 10.0, soft, display::TextAnchor::end);
    std::vector<SpectrumCurve> spectra, envelope;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const double y = legend + row * static_cast<double>(i);
        figure.line({{left, y}, {left + 26.0, y}}, shown[i].curve.colour, 2.2, shown[i].curve.dash);
        figure.text({left + 34.0, y + 4.0}, name_of(shown[i], files), 11.0, ink);
        figure.text({left + width, y + 4.0}, facts_of(shown[i]), 10.0, soft, display::TextAnchor::end);
        spectra.push_back(shown[i].curve);
        const auto& of_envelope = shown[i].channel->report.envelope_spectrum;
        if (!of_envelope || of_envelope->power.size() < 8) continue;
        envelope.push_back(shown[i].curve);
        envelope.back().spectrum = &*of_envelope;
    }
    const analysis::AnalysedFile& first = files.front();
    draw_spectra(figure, {left, top, width, height, lowest, highest}, spectra, level_unit(first), first.marks);
    figure.text({left + width, top + height + 28.0}, "frequency, Hz", 11.0, ink, display::TextAnchor::end);
    if (!envelope.empty())
        draw_envelopes(
            figure,
            {left, top + height + 60.0, width, envelope_height, 0.0, end_of_envelope(*first.envelope, first.marks)},
            envelope,
            fmt::format("envelopes of {} to {}", readable(first.envelope->first, "Hz"),
                        readable(first.envelope->second, "Hz")),
            "dB re (" + envelope.front().reference.text + ")²/Hz", first.marks);
    return figure;
}

}  // namespace tactus::report
