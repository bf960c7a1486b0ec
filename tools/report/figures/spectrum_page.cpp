// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/spectrum_page.hpp"

#include "dsp/core/readable.hpp"
#include "tools/analysis/vibration/level_reference.hpp"
#include "tools/analysis/vibration/record.hpp"
#include "tools/counted.hpp"
#include "tools/report/figures/html_report.hpp"
#include "tools/report/figures/spectrum_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::report {

namespace {

std::string row(const std::string& name, const signal::SpectralLine& line, const analysis::LevelReference& reference) {
    return fmt::format(
        "<tr><td>{}</td><td class=\"n\">{:.3f}</td><td class=\"n\">{:.1f}</td><td class=\"n\">{:.1f}</td></tr>\n", name,
        line.frequency, reference.db(line.power), line.snr_db);
}

std::string lines_table(const signal::VibrationReport& r, const analysis::LevelReference& reference) {
    std::string out = fmt::format(
        "<table><tr><th>line</th><th class=\"n\">Hz</th><th class=\"n\">rms, dB re {}</th><th class=\"n\">SNR, dB</th>"
        "</tr>\n",
        reference.text);
    for (const signal::Harmonic& h : r.harmonics)
        if (h.present) out += row(fmt::format("order {}", h.order), h, reference);
    for (const signal::HumLine& h : r.hum) out += row(fmt::format("hum, {} × {} Hz", h.order, h.mains), h, reference);
    const auto is_named = [&](const signal::SpectralLine& line) {
        const auto near = [&](const signal::SpectralLine& other) {
            return std::abs(line.frequency - other.frequency) < r.lines.df;
        };
        for (const signal::Harmonic& h : r.harmonics)
            if (h.present && near(h)) return true;
        return std::ranges::any_of(r.hum, near);
    };
    for (const signal::SpectralLine& line : r.peaks)
        if (!is_named(line)) out += row("–", line, reference);
    for (const signal::SpectralLine& line : r.envelope) out += row("of the envelope", line, reference);
    return out + "</table>\n";
}

std::string bands_table(const signal::VibrationReport& r, const analysis::LevelReference& reference) {
    std::string out = fmt::format(
        "<table><tr><th class=\"n\">third octave, Hz</th><th class=\"n\">rms, dB re {}</th><th class=\"n\">± "
        "dB</th></tr>\n",
        reference.text);
    for (const signal::Band& band : r.bands)
        out += fmt::format("<tr><td class=\"n\">{}</td><td class=\"n\">{:.1f}</td><td class=\"n\">{:.2f}</td></tr>\n",
                           plain(band.centre, 4), reference.db(band.power), analysis::band_deviation(band, r.lines));
    return out + "</table>\n";
}

std::string marks_table(const analysis::AnalysedChannel& channel, const analysis::LevelReference& reference) {
    if (channel.marks.empty() && channel.envelope_marks.empty()) return {};
    std::string out = fmt::format(
        "<table><tr><th>mark</th><th class=\"n\">Hz</th><th>in</th><th>found</th><th class=\"n\">rms, dB re {}</th>"
        "<th class=\"n\">SNR, dB</th><th class=\"n\">nearest line, Hz</th></tr>\n",
        reference.text);
    const auto add = [&](const char* where, const std::vector<analysis::MarkLevel>& levels) {
        for (const analysis::MarkLevel& level : levels)
            out += fmt::format(
                "<tr><td>{}</td><td class=\"n\">{:.2f}</td><td>{}</td><td>{}</td><td class=\"n\">{:.1f}</td>"
                "<td class=\"n\">{:.1f}</td><td class=\"n\">{}</td></tr>\n",
                html::escaped(level.place.name()), level.place.frequency, where, level.is_line ? "line" : "no line",
                reference.db(level.line.power), level.line.snr_db,
                level.nearest ? fmt::format("{:.2f}", level.nearest->frequency) : "–");
    };
    add("spectrum", channel.marks);
    add("envelope", channel.envelope_marks);
    return out + "</table>\n";
}

std::string channel_section(const analysis::AnalysedChannel& channel, const analysis::AnalysedFile& file) {
    const signal::VibrationReport& r = channel.report;
    std::string out =
        fmt::format("<h3>Channel {}</h3>\n<p>Root mean square {}{}, crest factor {:.3g}. ", html::escaped(channel.name),
                    html::escaped(readable(r.level.rms(), file.calibration.unit, 4)),
                    file.calibration.known ? "" : " (uncalibrated)", r.level.crest());
    if (r.fundamental.frequency > 0.0) {
        out += fmt::format("Fundamental {:.3f} Hz, confidence {:.2f}{}", r.fundamental.frequency,
                           r.fundamental.confidence, r.fundamental.is_certain() ? "" : ", uncertain");
        for (const signal::HarmonicSum& rival : r.fundamental.rivals)
            out += fmt::format("{} {:.1f} Hz", &rival == r.fundamental.rivals.data() ? "; or" : ",", rival.frequency);
        out += ".</p>\n";
    } else {
        out += "No fundamental.</p>\n";
    }
    if (!channel.warnings.empty()) {
        out += "<ul>";
        for (const std::string& warning : channel.warnings) out += "<li>" + html::escaped(warning) + "</li>";
        out += "</ul>\n";
    }
    const analysis::LevelReference reference = analysis::level_reference(file.calibration);
    return out + marks_table(channel, reference) + lines_table(r, reference) + bands_table(r, reference);
}

}  // namespace

std::string analysis_section(const analysis::AnalysedFile& file, const SpectrumMethod& method) {
    std::string out = fmt::format("<h2>{}</h2>\n", html::escaped(file.file.filename().string()));
    std::string mark = "s";
    // A unique text of letters for every file of a page.
    for (const char c : file.file.string()) {
        mark += static_cast<char>('a' + static_cast<unsigned char>(c) / 16);
        mark += static_cast<char>('a' + static_cast<unsigned char>(c) % 16);
    }
    out += html::drawing(draw_spectrum(file, method.band), mark);
    out += fmt::format("<p>{} at {}, {}; {} of {} samples.</p>\n", readable(file.duration, "s", 4),
                       readable(file.rate, "Hz", 6), counted(file.channels.size(), "channel"),
                       counted(file.channels.empty() ? 0 : file.channels.front().report.psd.segments, "segment"),
                       file.psd.segment);
    if (!file.stretch.is_whole()) out += fmt::format("<p>Of the record: {}.</p>\n", file.stretch.text());
    for (const std::string& line : analysis::understood(file.recorded, file.log, file.rate))
        out += fmt::format("<p>{}.</p>\n", html::escaped(line));
    if (!method.envelope.empty()) out += fmt::format("<p>Envelope of the band {} Hz.</p>\n", method.envelope);
    for (const analysis::AnalysedChannel& channel : file.channels) out += channel_section(channel, file);
    return out;
}

std::string analysis_method(const SpectrumMethod& method) {
    return fmt::format(
        "<h2>Methods</h2><ul>"
        "<li>Curves: Welch, window {}, overlap {:g} %, detrend {}, average {}, scaling {}.</li>"
        "<li>Lines and bands: Welch, Hann, half overlapping, mean of each segment removed. Between bins by the ratio "
        "of "
        "the two strongest (Hann); SNR over the median of the bins 4 to 16 away. Levels are of the root mean square. "
        "A line needs an SNR that a noise bin exceeds once in a million.</li>"
        "<li>Fundamental from {} Hz: harmonic sums of half seconds, joined to a path over time, and of the whole "
        "record; uncertain below a confidence of 0.25.</li>"
        "<li>Third octaves have centres 10^(n/10) Hz; ± is one standard deviation of noise in the band.</li></ul>\n",
        method.window, 100.0 * method.overlap, method.detrend, method.average, method.scaling,
        html::escaped(method.fundamental));
}

}  // namespace tactus::report
