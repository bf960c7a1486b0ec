// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/comparison_page.hpp"

#include "dsp/core/readable.hpp"
#include "tools/report/figures/comparison_figure.hpp"
#include "tools/report/figures/html_report.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus::report {

namespace {

std::string score_row(const std::string& name, const std::string& value, const std::string& limit,
                      const std::string& verdict, const std::string& about) {
    return fmt::format("<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>{}<td>{}</td></tr>\n", name, value,
                       limit, verdict, about);
}

std::string scores_table(const analysis::ComparedPair& pair) {
    const signal::Comparison& c = pair.comparison;
    std::string out =
        "<table><tr><th>score</th><th class=\"n\">value</th><th class=\"n\">threshold</th><th>verdict</th><th>what it "
        "says</th></tr>\n";
    for (const analysis::Judged& s : pair.verdict.scores)
        out += score_row(s.name, plain(s.value), fmt::format("{} {:g}", s.at_least ? "≥" : "≤", s.limit),
                         s.passed ? "<td class=\"pass\">pass</td>" : "<td class=\"fail\">fail</td>",
                         html::escaped(s.about));
    const auto unjudged = [&](const char* name, const std::optional<double>& value, const char* unit,
                              const char* about) {
        for (const analysis::Judged& s : pair.verdict.scores)
            if (s.name == name) return;
        out += score_row(name, value ? plain(*value) + unit : "–", "", "<td>not judged</td>", about);
    };
    unjudged("gain_db", c.gain_db, " dB", "gain that equalises the power in the band");
    unjudged(
        "level_gap_db", pair.level_gap_db, " dB",
        pair.actuator_known ? "missing level with the actuator at its limit" : "missing level of the output as played");
    unjudged("third_octave_rms_db", c.third_octave_rms_db, " dB", "all third-octave bands");
    unjudged("spectrogram_similarity", c.spectrogram_similarity, "", "correlation of the spectrograms");
    const char* aligned = c.alignment.significant ? "aligned takes of one recording" : "only of aligned takes";
    unjudged("st_sim", c.st_sim, "", aligned);
    unjudged("spqi", c.spqi, "", aligned);
    unjudged("coherence_mean", c.coherence_mean, "", aligned);
    unjudged("touch cosine", c.touch_cosine, "", "perceived shape");
    unjudged("touch gap", c.touch_gap_db, " dB", "perceived strength of the output at equal power");
    return out + "</table>\n";
}

std::string lines_table(const signal::Comparison& c) {
    std::string out =
        "<table><tr><th>line</th><th class=\"n\">Hz</th><th class=\"n\">rms, dB</th><th class=\"n\">SNR, dB</th>"
        "<th>where</th></tr>\n";
    const auto rows = [&](const std::vector<signal::SpectralLine>& lines, double fundamental, const char* where) {
        for (const signal::SpectralLine& line : lines) {
            const std::string name = analysis::name_of_line(line.frequency, fundamental);
            out += fmt::format(
                "<tr><td>{}</td><td class=\"n\">{:.2f}</td><td class=\"n\">{:.1f}</td><td class=\"n\">"
                "{:.1f}</td><td>{}</td></tr>\n",
                name.empty() ? "–" : name, line.frequency, signal::rms_db(line), line.snr_db, where);
        }
    };
    rows(c.lines.in_both, c.reference_hz, "both");
    rows(c.lines.only_in_reference, c.reference_hz, "only in the reference");
    rows(c.lines.only_in_output, c.output_hz > 0.0 ? c.output_hz : c.reference_hz, "only in the output");
    return out + "</table>\n";
}

std::string bands_table(const signal::Comparison& c) {
    std::string centres, errors;
    for (const signal::BandError& band : c.third_octaves) {
        centres += fmt::format("<th class=\"n\">{:.0f}</th>", band.hz);
        errors += fmt::format("<td class=\"n\">{:+.1f}</td>", band.error_db);
    }
    return fmt::format("<table><tr><th>Hz</th>{}</tr><tr><td>dB</td>{}</tr></table>\n", centres, errors);
}

}  // namespace

std::string comparison_section(const analysis::ComparedPair& pair, const std::string& mark) {
    const signal::Comparison& c = pair.comparison;
    std::string out = html::drawing(draw_comparison(pair), mark);
    if (c.alignment.significant)
        out += fmt::format(
            "<p>One recording: the output lags by {:.3f} ms and correlates by {:.3f}; coherence, ST-SIM and SPQI are "
            "of "
            "the aligned takes.</p>\n",
            1e3 * c.alignment.delay, c.alignment.correlation);
    else
        out +=
            "<p>Two recordings: nothing shows that they were made together, so coherence, ST-SIM and SPQI do not "
            "apply.</p>\n";
    out += "<h2>Scores</h2>\n" + scores_table(pair);
    out += "<h2>Lines</h2>\n" + lines_table(c);
    out += "<h2>Third-octave bands, output minus reference</h2>\n" + bands_table(c);
    if (!pair.notes.empty()) {
        out += "<h2>Notes</h2><ul>";
        for (const std::string& note : pair.notes) out += "<li>" + html::escaped(note) + "</li>";
        out += "</ul>\n";
    }
    return out;
}

std::string comparison_method(const analysis::ComparedPair& pair) {
    const signal::Comparison& c = pair.comparison;
    return fmt::format(
        "<h2>Methods</h2><ul>"
        "<li>Band {:g} to {:g} Hz; both takes are resampled to 8 kHz. For all scores but the level, the output is "
        "scaled to the reference's power in the band.</li>"
        "<li>Takes count as one recording when the peak of their whitened cross-correlation is significant (chance "
        "below 1 in 1000); otherwise only spectra are compared, at equal orders of the saw when both rates are known "
        "and within 3 %.</li>"
        "<li>Spectra: Welch, Hann, half overlapping, mean of each segment removed. Segments of 1024 samples for "
        "lsd_db and the cosines, 2048 for coherence, 4096 for the third-octave bands and the curves, 8192 for lines "
        "and orders; shorter when a take does not hold four. The curves have a resolution of {:.3g} Hz.</li>"
        "<li>The band is what both takes can be trusted in, at most 40 to 1000 Hz; lsd_db and cosine_40_500 end at 500 "
        "Hz "
        "where the band does not end before. above_noise counts lines and third-octave bands that stand above the "
        "noise in both takes: without one, noise would be compared with noise.</li>"
        "<li>lsd_db: rms of the level differences, levels limited to 40 dB below the reference's "
        "maximum. "
        "Cosines are of amplitude spectra. Third octaves have centres 10^(n/10) Hz; bands within 40 dB of the "
        "strongest count. harmonic_error_db: the worst order's difference from the mean difference.</li>"
        "<li>Lines: Hann interpolation between bins; they stand 10 dB or more above their neighbourhood and within 60 "
        "dB of the strongest. Levels are dB re 1 of the record's unit, rms.</li>"
        "<li>Over time: levels of 20 ms in the band. Aligned takes may differ by 3 dB rms (course_db). Of separate "
        "takes "
        "the kurtosis, the spread of the level and the depth of its modulation must agree within a tolerance and the "
        "spread of their own halves (statistics); the order in time is then not judged.</li>"
        "<li>Spectrograms: Hann windows of 60 ms, each shown down to 60 dB below its own maximum.</li>"
        "<li>Touch: threshold curve of {}. Above 500 Hz vibration is hardly perceptible.</li></ul>\n",
        c.lowest, c.highest, c.step, analysis::touch_unit(pair.touch));
}

std::string comparison_page(const analysis::ComparedPair& pair) {
    const bool passed = pair.verdict.passed();
    std::string failed;
    for (const std::string& name : pair.verdict.failed()) failed += (failed.empty() ? "" : ", ") + name;
    std::string body = fmt::format(
        "<p>Reference: {}<br>Output: {}</p>\n<p class=\"{}\"><b>{}</b></p>\n", html::escaped(pair.reference.string()),
        html::escaped(pair.output.string()), passed ? "pass" : "fail",
        passed ? "Pass: every score reaches its threshold. " + html::escaped(pair.verdict.words()) + "."
               : "Fail: " + failed);
    return html::page(pair.verdict.words(), body + comparison_section(pair, "a") + comparison_method(pair));
}

}  // namespace tactus::report
