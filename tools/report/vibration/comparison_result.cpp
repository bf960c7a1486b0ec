// SPDX-License-Identifier: Apache-2.0
#include "tools/report/vibration/comparison_result.hpp"

#include "dsp/core/readable.hpp"
#include "tools/report/figures/comparison_figure.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/report/vibration/record_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

namespace tactus::report {

namespace {

using analysis::ComparedPair;
using analysis::Judged;
using analysis::Validation;
using analysis::ValidationRun;
using file::Json;
using signal::Comparison;
using Pair = ComparedPair;

/// Of `comparison`.
template <class Read>
auto in(Read read) {
    return [read](const Pair& p) { return std::invoke(read, p.comparison); };
}

/// Of aligned takes only.
template <class Read>
auto if_aligned(Read read) {
    return [read](const Pair& p) {
        const signal::Alignment& alignment = p.comparison.alignment;
        return alignment.significant ? std::optional<double>(std::invoke(read, alignment)) : std::nullopt;
    };
}

std::string verdict_of(const Pair& p) { return p.verdict.passed() ? "pass" : "fail"; }
Severity severity_of(const Pair& p) { return p.verdict.passed() ? Severity::pass : Severity::fail; }

/// A value of the reference and one of the output.
struct Both {
    std::optional<double> reference, output;
};

const Fields<Both>& both_fields() {
    static const Fields<Both> all = Fields<Both>("value of the reference and of the output")
                                        .number("reference", "reference", significant(4), &Both::reference)
                                        .number("output", "output", significant(4), &Both::output);
    return all;
}

/// A line with its name, which may be empty.
struct Line {
    const signal::SpectralLine* line;
    std::string name;
    const char* where;
};

std::vector<Line> in_both(const Pair& p) {
    const analysis::LineNames names(p.comparison);
    std::vector<Line> all;
    for (const signal::SpectralLine& line : p.comparison.lines.in_both)
        all.push_back({&line, names.of_reference(line.frequency), "both"});
    return all;
}
std::vector<Line> only_in_reference(const Pair& p) {
    const analysis::LineNames names(p.comparison);
    std::vector<Line> all;
    for (const signal::SpectralLine& line : p.comparison.lines.only_in_reference)
        all.push_back({&line, names.of_reference(line.frequency), "only in the reference"});
    return all;
}
std::vector<Line> only_in_output(const Pair& p) {
    const analysis::LineNames names(p.comparison);
    std::vector<Line> all;
    for (const signal::SpectralLine& line : p.comparison.lines.only_in_output)
        all.push_back({&line, names.of_output(line.frequency), "only in the output"});
    return all;
}

std::vector<Line> all_lines(const Pair& p) {
    std::vector<Line> all = in_both(p);
    for (const auto& more : {only_in_reference(p), only_in_output(p)}) all.insert(all.end(), more.begin(), more.end());
    return all;
}

/// At most eight lines by frequency and name.
template <std::vector<Line> (*lines)(const Pair&)>
std::string few(const Pair& p) {
    constexpr std::size_t max_lines = 8;
    const std::vector<Line> all = lines(p);
    std::vector<std::string> names;
    for (const Line& line : std::span(all).first(std::min(max_lines, all.size()))) {
        names.push_back(
            fmt::format("{:.1f} Hz{}", line.line->frequency, line.name.empty() ? "" : " (" + line.name + ")"));
    }
    if (all.size() > max_lines) names.push_back(fmt::format("and {} more", all.size() - max_lines));
    return fmt::format("{}", fmt::join(names, ", "));
}

const Fields<Line>& line_fields() {
    static const Fields<Line> all =
        Fields<Line>("line of a spectrum")
            .text("", "line", &Line::name)
            .number("hz", "frequency", fixed(2, "Hz"), [](const Line& l) { return l.line->frequency; })
            .number("rms", "", significant(4), [](const Line& l) { return std::sqrt(l.line->power); })
            .number("rms_db", "rms", fixed(1, "dB"), [](const Line& l) { return signal::rms_db(*l.line); })
            // Of the amplitude, as before; it goes with the next release.
            .number("db", "", fixed(1, "dB"), [](const Line& l) { return signal::level_db(*l.line); })
            .number("snr_db", "SNR", fixed(1, "dB"), [](const Line& l) { return l.line->snr_db; })
            .text("name", "",
                  [](const Line& l) { return l.name.empty() ? std::nullopt : std::optional(l.name); })
            .omitted()
            .text("", "in", [](const Line& l) { return std::string(l.where); });
    return all;
}

const Fields<Judged>& judged_fields() {
    const auto limit_if = [](bool at_least) {
        return [at_least](const Judged& s) { return s.at_least == at_least ? std::optional(s.limit) : std::nullopt; };
    };
    static const Fields<Judged> all =
        Fields<Judged>("score beside its threshold")
            .text("", "verdict", [](const Judged& s) { return s.passed ? "ok" : "FAIL"; })
            .judged([](const Judged& s) { return s.passed ? Severity::pass : Severity::fail; })
            .text("name", "score", &Judged::name)
            .number("value", "value", fixed(3), &Judged::value)
            .text("", "threshold",
                  [](const Judged& s) { return fmt::format("{} {:g}", s.at_least ? "at least" : "at most", s.limit); })
            .text("", "about", &Judged::about)
            .number("at_least", "", significant(4), limit_if(true))
            .omitted()
            .number("at_most", "", significant(4), limit_if(false))
            .omitted()
            .flag("passed", "", &Judged::passed)
            .range("band_hz", "", significant(4, "Hz"),
                   [](const Judged& s) { return std::optional(std::pair(s.lowest, s.highest)); });
    return all;
}

/// Failed scores first.
std::vector<Judged> scores_of(const Pair& p) {
    std::vector<Judged> all = p.verdict.scores;
    std::ranges::stable_partition(all, [](const Judged& s) { return !s.passed; });
    return all;
}

const Fields<signal::BandError>& octave_fields() {
    using B = signal::BandError;
    static const Fields<B> all =
        Fields<B>("third octave, output less reference")
            .number("hz", "third octave", fixed(0, "Hz"), &B::hz)
            .number("error_db", "output less reference", fixed(1, "dB").with_sign(), &B::error_db);
    return all;
}

std::string recordings_text(const Pair& p) {
    const Comparison& c = p.comparison;
    if (!c.alignment.significant)
        return "Two recordings: nothing shows that they were made together; ST-SIM, SPQI and coherence do not apply";
    return fmt::format("One recording: the output is {:.3f} ms {}{} and correlates by {:.3f}; {}coherence {:.3f}",
                       1e3 * std::abs(c.alignment.delay), c.alignment.delay < 0.0 ? "early" : "late",
                       c.alignment.correlation < 0.0 ? " and inverted" : "", c.alignment.correlation,
                       c.st_sim ? fmt::format("ST-SIM {:.3f}, SPQI {:.3f}, ", *c.st_sim, *c.spqi) : "",
                       *c.coherence_mean);
}

std::string saw_text(const Pair& p) {
    const Comparison& c = p.comparison;
    if (!(std::max({c.reference_hz, c.output_hz, c.reference_hum_hz, c.output_hum_hz}) > 0.0)) return {};
    const auto rate_in = [](double hz, double hum_hz, const char* name) {
        if (hz > 0.0) return fmt::format("{:.2f} Hz in the {}", hz, name);
        if (hum_hz > 0.0) return fmt::format("{:.2f} Hz in the {} (or mains hum: not used)", hum_hz, name);
        return fmt::format("not found in the {}", name);
    };
    return fmt::format("{}, {}{}", rate_in(c.reference_hz, c.reference_hum_hz, "reference"),
                       rate_in(c.output_hz, c.output_hum_hz, "output"),
                       c.speed_ratio != 1.0 ? "; compared at equal orders" : "");
}

std::string level_text(const Pair& p) {
    if (p.level_gap_db > 0.0)
        return fmt::format("{} lacks {:.1f} dB",
                           p.actuator_known ? "the actuator at its limit" : "the output as it was played",
                           p.level_gap_db);
    return p.actuator_known ? "the actuator can reach it" : "no level is missing";
}

const Fields<Pair>& touch_fields() {
    static const Fields<Pair> all =
        Fields<Pair>("spectra as they are perceived")
            .text("threshold_of", "", [](const Pair& p) { return analysis::touch_unit(p.touch); })
            .number("cosine_40_1000", "", fixed(3), in(&Comparison::touch_cosine))
            .number("gap_db", "", fixed(1, "dB"), in(&Comparison::touch_gap_db));
    return all;
}

const Fields<signal::StatisticsDifference>& statistics_fields() {
    using S = signal::StatisticsDifference;
    static const Fields<S> all = Fields<S>("difference of the statistics over time")
                                     .number("deviation", "", significant(4), &S::deviation)
                                     .text("worst", "", &S::worst);
    return all;
}

const Fields<signal::AboveNoise>& noise_fields() {
    using N = signal::AboveNoise;
    static const Fields<N> all =
        Fields<N>("lines and bands above the noise")
            .integer("reference", "", &N::in_reference)
            .integer("output", "", &N::in_output)
            .series("both_hz", [](const N& n) {
                return ResultEntry::Series{n.in_both.size(), [&n](std::size_t i) { return n.in_both[i]; }};
            });
    return all;
}

struct Stretches {
    const sound::ReadStretch &reference, &output;
};

const Fields<Stretches>& stretches_fields() {
    static const Fields<Stretches> all =
        Fields<Stretches>("stretches that were compared")
            .child("reference", "", stretch_fields(), [](const Stretches& s) -> const auto& { return s.reference; })
            .child("output", "", stretch_fields(), [](const Stretches& s) -> const auto& { return s.output; });
    return all;
}

template <class Read>
auto both(Read reference, Read output) {
    return [=](const Pair& p) { return Both{std::invoke(reference, p.comparison), std::invoke(output, p.comparison)}; };
}

std::optional<double> if_found(double hz) { return hz > 0.0 ? std::optional(hz) : std::nullopt; }

std::string pair_title(const Pair& p) {
    const double gain = p.comparison.gain_db;
    return fmt::format(
        "{}: {} {} the vibration of {}{}{}", p.verdict.passed() ? "PASS" : "FAIL", p.output.string(),
        p.verdict.passed()      ? "has"
        : p.verdict.is_judged() ? "does not have"
                                : "cannot be judged to have",
        p.reference.string(),
        std::abs(gain) < 0.5 ? "" : fmt::format(", {:.1f} dB {}", std::abs(gain), gain > 0.0 ? "softer" : "louder"),
        p.not_judged > 0.0 && p.verdict.passed()
            ? fmt::format(", from {:.0f} to {:.0f} Hz; {:.0f} % of the power is not judged", p.verdict.lowest,
                          p.verdict.highest, 100.0 * p.not_judged)
            : "");
}

const Fields<Pair>& pair_fields() {
    using C = Comparison;
    static const Fields<Pair> all =
        Fields<Pair>("comparison of two records")
            .titled(pair_title)
            .figure(
                "spectra and spectrograms", [](const Pair&) { return true; }, draw_comparison)
            .text("verdict_scope", "verdict", [](const Pair& p) { return p.verdict.words(); })
            .judged(severity_of)
            .rows("", "scores", judged_fields(), scores_of)
            .texts("not_judged", "not judged", [](const Pair& p) { return p.verdict.not_judged; })
            .text("alignment", "",
                  [](const Pair& p) { return p.comparison.alignment.significant ? "correlation" : "none"; })
            .text("", "recordings", recordings_text)
            .text("", "saw", saw_text)
            .number("delay_s", "", fixed(3, "ms", "s"), if_aligned(&signal::Alignment::delay))
            .number("gain_db", "gain to equal power", fixed(2, "dB").with_sign(), in(&C::gain_db))
            .number("lsd_db", "", fixed(2, "dB"), in(&C::lsd_db))
            .number("cosine_40_500", "", fixed(4), in(&C::cosine_500))
            .number("cosine_40_1000", "", fixed(4),
                    in([](const C& c) { return c.highest >= 999.0 ? std::optional(c.cosine_1000) : std::nullopt; }))
            .number("harmonic_error_db", "", fixed(2, "dB"), in(&C::harmonic_error_db))
            .rows("third_octave", "third octaves", octave_fields(),
                  [](const Pair& p) -> const auto& { return p.comparison.third_octaves; })
            .on_pages()
            .number("third_octave_max_db", "", fixed(2, "dB"), in(&C::third_octave_max_db))
            .number("third_octave_rms_db", "third octaves, rms", fixed(2, "dB"), in(&C::third_octave_rms_db))
            .number("spectrogram_similarity", "spectrograms correlate by", fixed(3), in(&C::spectrogram_similarity))
            .number("st_sim", "", fixed(3), in(&C::st_sim))
            .number("spqi", "", fixed(3), in(&C::spqi))
            .number("coherence_mean", "", fixed(3), in(&C::coherence_mean))
            .child("touch", "", touch_fields(), [](const Pair& p) -> const Pair& { return p; })
            .text("", "as touched",
                  [](const Pair& p) {
                      const C& c = p.comparison;
                      return fmt::format("shape {:.3f}; feels {:.1f} dB {} at equal power (threshold of {})",
                                         c.touch_cosine, std::abs(c.touch_gap_db),
                                         c.touch_gap_db < 0.0 ? "weaker" : "stronger", analysis::touch_unit(p.touch));
                  })
            .number("level_gap_db", "", fixed(1, "dB"), &Pair::level_gap_db)
            .text("level_gap_of", "",
                  [](const Pair& p) {
                      return p.actuator_known ? "the actuator at its limit" : "the output as it was played";
                  })
            .text("", "level", level_text)
            .text("verdict", "", verdict_of)
            .texts("failed", "", [](const Pair& p) { return p.verdict.failed(); })
            .number("course_db", "", fixed(2, "dB"), in(&C::course_db))
            .child("statistics", "", statistics_fields(),
                   [](const Pair& p) -> const auto& { return p.comparison.statistics; })
            .child("kurtosis", "", both_fields(), both(&C::reference_kurtosis, &C::output_kurtosis))
            .child("power_in_band", "", both_fields(), both(&C::reference_inside, &C::output_inside))
            .rows("only_in_reference", "", line_fields(), only_in_reference)
            .text("", "only in reference", few<only_in_reference>)
            .rows("only_in_output", "", line_fields(), only_in_output)
            .text("", "only in output", few<only_in_output>)
            .rows("in_both", "", line_fields(), in_both)
            .text("", "in both", few<in_both>)
            .rows("", "lines", line_fields(), all_lines)
            .on_pages()
            .number("snr_db", "", fixed(1, "dB"), in(&C::signal_to_noise_db))
            .number("correlation", "", fixed(3), if_aligned(&signal::Alignment::correlation))
            .child("fundamental_hz", "", both_fields(),
                   [](const Pair& p) {
                       return Both{if_found(p.comparison.reference_hz), if_found(p.comparison.output_hz)};
                   })
            .number("speed_ratio", "", significant(6), in(&C::speed_ratio))
            .range("band_hz", "band", fixed(0, "Hz"),
                   in([](const C& c) { return std::optional(std::pair(c.lowest, c.highest)); }))
            .child("stretch", "", stretches_fields(),
                   [](const Pair& p) { return Stretches{p.stretches[0], p.stretches[1]}; })
            .child("rms", "", both_fields(), both(&C::reference_rms, &C::output_rms))
            .text("db_re", "", [](const Pair&) { return "1 of the record's unit, rms"; })
            .child("above_noise", "", noise_fields(),
                   [](const Pair& p) -> const auto& { return p.comparison.above_noise; })
            .rows("scores", "", judged_fields(), [](const Pair& p) -> const auto& { return p.verdict.scores; })
            .notes("notes", "note", &Pair::notes);
    return all;
}

/// A line of many pairs.
const Fields<Pair>& score_fields() {
    using C = Comparison;
    static const Fields<Pair> all =
        Fields<Pair>("main scores of a comparison")
            .text("verdict", "verdict", [](const Pair& p) { return p.verdict.passed() ? "pass" : "FAIL"; })
            .judged(severity_of)
            .number("lsd_db", "LSD", fixed(2, "dB"), in(&C::lsd_db))
            .number("cosine_40_500", "cosine", fixed(4), in(&C::cosine_500))
            .number("harmonic_error_db", "worst order", fixed(2, "dB"), in(&C::harmonic_error_db))
            .number("third_octave_max_db", "worst band", fixed(2, "dB"), in(&C::third_octave_max_db))
            .number("gain_db", "softer by", fixed(1, "dB"), in(&C::gain_db))
            .integer("", "added", [](const Pair& p) { return p.verdict.added.size(); })
            .integer("", "lost", [](const Pair& p) { return p.verdict.missing.size(); })
            .texts("failed", "fails by", [](const Pair& p) { return p.verdict.failed(); });
    return all;
}

std::vector<std::string> methods(const Pair& pair) {
    const Comparison& c = pair.comparison;
    return {
        fmt::format("Band {:g} to {:g} Hz; both takes are resampled to 8 kHz. For all scores but the level, the output "
                    "is scaled to the reference's power in the band.",
                    c.lowest, c.highest),
        "Takes count as one recording when the peak of their whitened cross-correlation is significant (chance below 1 "
        "in 1000); otherwise only spectra are compared, at equal orders of the saw when both rates are known and "
        "within 3 %.",
        fmt::format(
            "Spectra: Welch, Hann, half overlapping, mean of each segment removed. Segments of 1024 samples for "
            "lsd_db and the cosines, 2048 for coherence, 4096 for the third-octave bands and the curves, 8192 "
            "for lines and orders; shorter when a take does not hold four. The curves have a resolution of "
            "{:.3g} Hz.",
            c.step),
        "The band is what both takes can be trusted in, at most 40 to 1000 Hz; lsd_db and cosine_40_500 end at 500 Hz "
        "where the band does not end before. above_noise counts lines and third-octave bands that stand above the "
        "noise in both takes: without one, noise would be compared with noise.",
        "lsd_db: rms of the level differences, levels limited to 40 dB below the reference's maximum. Cosines are of "
        "amplitude spectra. Third octaves have centres 10^(n/10) Hz; bands within 40 dB of the strongest count. "
        "harmonic_error_db: the worst order's difference from the mean difference.",
        "Lines: Hann interpolation between bins; they stand 10 dB or more above their neighbourhood and within 60 dB "
        "of the strongest. Levels are dB re 1 of the record's unit, rms.",
        "Over time: levels of 20 ms in the band. Aligned takes may differ by 3 dB rms (course_db). Of separate takes "
        "the kurtosis, the spread of the level and the depth of its modulation must agree within a tolerance and the "
        "spread of their own halves (statistics); the order in time is then not judged.",
        "Spectrograms: Hann windows of 60 ms, each shown down to 60 dB below its own maximum.",
        fmt::format("Touch: threshold curve of {}. Above 500 Hz vibration is hardly perceptible.",
                    analysis::touch_unit(pair.touch))};
}

struct TriedPair {
    const Pair* pair;
    std::string error;
    std::string name;
};

std::vector<TriedPair> tried_pairs(const ComparedPairs& all) {
    std::vector<TriedPair> tried;
    for (std::size_t i = 0; i < all.pairs.size(); ++i)
        tried.push_back({&all.pairs[i], all.errors[i], analysis::pair_name(all.pairs[i], all.pairs)});
    return tried;
}

bool has_failed(const TriedPair& t) { return !t.error.empty(); }
std::string reference_of(const TriedPair& t) { return t.pair->reference.string(); }
std::string output_of(const TriedPair& t) { return t.pair->output.string(); }
const Pair& pair_of(const TriedPair& t) { return *t.pair; }

const Fields<TriedPair>& tried_pair_fields() {
    static const Fields<TriedPair> failed = Fields<TriedPair>("pair that could not be compared")
                                                .titled([](const TriedPair& t) { return t.name; })
                                                .text("reference", "reference", reference_of)
                                                .text("output", "output", output_of)
                                                .text("error", "error", &TriedPair::error)
                                                .judged([](const TriedPair&) { return Severity::fail; });
    static const Fields<TriedPair> all = Fields<TriedPair>("comparison of two records")
                                             .text("reference", "", reference_of)
                                             .text("output", "", output_of)
                                             .part(pair_fields(), pair_of)
                                             .otherwise(has_failed, failed);
    return all;
}

const Fields<TriedPair>& pair_line_fields() {
    static const Fields<TriedPair> failed = Fields<TriedPair>("pair that could not be compared")
                                                .text("", "output", &TriedPair::name)
                                                .text("error", "error", &TriedPair::error)
                                                .judged([](const TriedPair&) { return Severity::fail; });
    static const Fields<TriedPair> all = Fields<TriedPair>("main scores of a comparison")
                                             .text("", "output", &TriedPair::name)
                                             .part(score_fields(), pair_of)
                                             .otherwise(has_failed, failed);
    return all;
}

std::vector<std::string> methods_of_pairs(const ComparedPairs& all) {
    for (std::size_t i = all.pairs.size(); i-- > 0;)
        if (all.errors[i].empty()) return methods(all.pairs[i]);
    return {};
}

const Fields<VerdictCounts>& count_fields() {
    static const Fields<VerdictCounts> all =
        Fields<VerdictCounts>("verdict over all comparisons")
            .text("verdict", "", [](const VerdictCounts& c) { return c.passes() ? "pass" : "fail"; })
            .integer("passed", "", &VerdictCounts::passed)
            .integer("failed", "", &VerdictCounts::failed)
            .integer("bad", "", &VerdictCounts::bad);
    return all;
}

/// What a table of comparisons adds to the JSON of one.
Json table_row(Json row, const Pair& pair) {
    std::vector<std::string> failed = pair.verdict.failed();
    row["failed"] = fmt::format("{}", fmt::join(failed, " "));
    row["reference_hz"] = pair.comparison.reference_hz;
    row["output_hz"] = pair.comparison.output_hz;
    row["lines_added"] = pair.verdict.added.size();
    row["lines_missing"] = pair.verdict.missing.size();
    return row;
}

const ValidationRun& as_run(const ValidationRun& run) { return run; }
bool run_has_failed(const ValidationRun& run) { return !run.failure.empty(); }

const Fields<ValidationRun>& condition_fields() {
    using R = ValidationRun;
    static const Fields<R> all =
        Fields<R>("condition of a run")
            .text("file", "", [](const R& r) { return r.recording->file.string(); })
            .text("state", "", [](const R& r) { return r.recording->cutting ? "cutting" : "free_air"; })
            .text("", "saw", [](const R& r) { return r.recording->cutting ? "cutting" : "free air"; })
            .number("rate_hz", "rate", significant(4, "Hz"), [](const R& r) { return r.recording->rate; })
            .number("load_N", "", significant(4, "N"), [](const R& r) { return r.recording->load; })
            .number("", "thrust", significant(4, "N"),
                    [](const R& r) { return r.recording->cutting ? std::optional(r.recording->load) : std::nullopt; })
            .number("level_db", "level", significant(4, "dB").with_sign(), &R::level_db)
            .number("drive_rms_v", "drive, rms", fixed(3, "V"), &R::drive_rms)
            .number("drive_peak_v", "drive, peak", fixed(3, "V"), &R::drive_peak);
    return all;
}

/// `scores`: all fields of a comparison, or those of a line.
Fields<ValidationRun> run_fields(const Fields<Pair>& scores, const Fields<ValidationRun>& failed) {
    return Fields<ValidationRun>("run of a patch beside the recording that its saw plays")
        .titled(&ValidationRun::name)
        .part(condition_fields(), as_run)
        .part(scores, [](const ValidationRun& r) -> const Pair& { return r.pair; })
        .otherwise(run_has_failed, failed);
}

const Fields<ValidationRun>& failed_run_fields() {
    static const Fields<ValidationRun> all = Fields<ValidationRun>("run that could not be compared")
                                                 .titled(&ValidationRun::name)
                                                 .part(condition_fields(), as_run)
                                                 .text("error", "error", &ValidationRun::failure)
                                                 .judged([](const ValidationRun&) { return Severity::fail; });
    return all;
}

const Fields<ValidationRun>& whole_run_fields() {
    static const Fields<ValidationRun> all = run_fields(pair_fields(), failed_run_fields());
    return all;
}

const Fields<ValidationRun>& run_line_fields() {
    static const Fields<ValidationRun> all = run_fields(score_fields(), failed_run_fields());
    return all;
}

const Fields<analysis::ValidateSettings>& run_stretch_fields() {
    using S = analysis::ValidateSettings;
    static const Fields<S> all =
        Fields<S>("stretch of each run that was compared")
            .number("from_s", "", significant(6, "s"), &S::from)
            .number("to_s", "", significant(6, "s"), [](const S& s) { return s.from + s.seconds; });
    return all;
}

std::vector<std::string> methods_of_runs(const ValidatedRuns& v) {
    for (std::size_t i = v.validation->runs.size(); i-- > 0;)
        if (!run_has_failed(v.validation->runs[i])) return methods(v.validation->runs[i].pair);
    return {};
}

}  // namespace

VerdictCounts ComparedPairs::counts() const {
    VerdictCounts count;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        ++(!errors[i].empty() ? count.bad : pairs[i].verdict.passed() ? count.passed : count.failed);
    return count;
}

VerdictCounts ValidatedRuns::counts() const {
    VerdictCounts count;
    for (const ValidationRun& run : validation->runs)
        ++(run_has_failed(run) ? count.bad : run.pair.verdict.passed() ? count.passed : count.failed);
    return count;
}

const Fields<ComparedPairs>& comparison_fields() {
    using P = ComparedPairs;
    static const auto is_many = [](const P& p) { return p.pairs.size() > 1; };
    static const Fields<P> all =
        Fields<P>("vibrations that were compared")
            .rows("", "pairs", pair_line_fields(),
                  [](const P& p) { return is_many(p) ? tried_pairs(p) : std::vector<TriedPair>(); })
            .children("pairs", "pair", tried_pair_fields(), tried_pairs)
            .printed([](const P& p) { return is_many(p) ? Where::pages : Where::everywhere; })
            .part(count_fields(), &P::counts)
            .text("", "verdict",
                  [](const P& p) {
                      return is_many(p) ? fmt::format("{} of {} pass", p.counts().passed, p.pairs.size())
                                        : std::string();
                  })
            .judged([](const P& p) { return p.counts().passes() ? Severity::pass : Severity::fail; })
            .notes("", "Methods", methods_of_pairs)
            .on_pages();
    return all;
}

std::string comparison_table(const ComparedPairs& pairs) {
    std::vector<Json> rows;
    for (const TriedPair& one : tried_pairs(pairs)) {
        rows.push_back(json_of(tried_pair_fields().of(one)));
        if (one.error.empty()) rows.back() = table_row(rows.back(), *one.pair);
    }
    return csv_table({"reference",
                      "output",
                      "verdict",
                      "failed",
                      "alignment",
                      "delay_s",
                      "gain_db",
                      "lsd_db",
                      "cosine_40_500",
                      "cosine_40_1000",
                      "harmonic_error_db",
                      "third_octave_max_db",
                      "third_octave_rms_db",
                      "spectrogram_similarity",
                      "st_sim",
                      "spqi",
                      "coherence_mean",
                      "level_gap_db",
                      "reference_hz",
                      "output_hz",
                      "lines_added",
                      "lines_missing",
                      "error"},
                     rows);
}

const Fields<ValidatedRuns>& validation_fields() {
    using V = ValidatedRuns;
    static const Fields<V> all =
        Fields<V>("runs of a patch beside the recordings that its saw plays")
            .titled([](const V& v) {
                return fmt::format(
                    "{} at {}, beside {}{}", v.validation->patch, v.validation->path.out,
                    v.validation->set->title.empty() ? v.validation->set->path.string() : v.validation->set->title,
                    v.validation->set->synthesised ? " (synthesised, no recordings)" : "");
            })
            .text("patch", "", [](const V& v) { return v.validation->patch; })
            .text("set", "set", [](const V& v) { return v.validation->set->path.string(); })
            .flag("synthesised", "", [](const V& v) { return v.validation->set->synthesised; })
            .flag("calibrated", "", [](const V& v) { return v.validation->set->calibrated(); })
            .text("out", "", [](const V& v) { return v.validation->path.out; })
            .child("stretch_of_run", "", run_stretch_fields(), [](const V& v) -> const auto& { return *v.settings; })
            .text("", "compared",
                  [](const V& v) {
                      return fmt::format(
                          "{} to {} s of each run, with the stretch of the recording that was played then",
                          plain(v.settings->from, 6), plain(v.settings->from + v.settings->seconds, 6));
                  })
            .part(count_fields(), &V::counts)
            .rows("", "runs", run_line_fields(), [](const V& v) -> const auto& { return v.validation->runs; })
            .children("runs", "run", whole_run_fields(), [](const V& v) -> const auto& { return v.validation->runs; })
            .on_pages()
            .text("", "verdict",
                  [](const V& v) {
                      return fmt::format("{}: {} of {} have the vibration of their recording",
                                         v.counts().passes() ? "PASS" : "FAIL", v.counts().passed,
                                         v.validation->runs.size());
                  })
            .judged([](const V& v) { return v.counts().passes() ? Severity::pass : Severity::fail; })
            .notes("", "How the runs were made",
                   [](const V&) {
                       return std::vector<std::string>{
                           "Each run is one offline rendering of the patch in which the saw plays the set at the "
                           "recording's rate and load, without the hand, the bone and other nodes that do not lead to "
                           "the handle. The first second is not compared.",
                           "The equaliser, if any, was designed from sweeps and not from recordings. The table states "
                           "the drive of each run, for comparison with the level of those sweeps.",
                           "\"Softer by\" is the missing power of the handle from 40 to 1000 Hz. An equaliser corrects "
                           "the shape, not the level."};
                   })
            .on_pages()
            .notes("", "Methods", methods_of_runs)
            .on_pages();
    return all;
}

std::string validation_table(const Validation& validation) {
    std::vector<Json> rows;
    for (const ValidationRun& run : validation.runs) {
        rows.push_back(json_of(whole_run_fields().of(run)));
        if (!run_has_failed(run)) rows.back() = table_row(rows.back(), run.pair);
    }
    return csv_table({"file",
                      "state",
                      "rate_hz",
                      "load_N",
                      "level_db",
                      "drive_rms_v",
                      "drive_peak_v",
                      "verdict",
                      "failed",
                      "lsd_db",
                      "cosine_40_500",
                      "cosine_40_1000",
                      "harmonic_error_db",
                      "third_octave_max_db",
                      "spectrogram_similarity",
                      "st_sim",
                      "spqi",
                      "coherence_mean",
                      "gain_db",
                      "lines_added",
                      "lines_missing",
                      "error"},
                     rows);
}

}  // namespace tactus::report
