// SPDX-License-Identifier: Apache-2.0
#include "tools/report/vibration/spectrum_result.hpp"

#include "dsp/core/readable.hpp"
#include "dsp/signal/spectrum/decibels.hpp"
#include "dsp/signal/spectrum/mains.hpp"
#include "tools/analysis/vibration/level_reference.hpp"
#include "tools/analysis/vibration/verdict.hpp"
#include "tools/counted.hpp"
#include "tools/report/result/printers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

namespace tactus::report {

namespace {

/// A record with the settings of its analysis.
struct FileSpectrum {
    const analysis::AnalysedFile& file;
    const SpectrumMethod* method;
};

using analysis::AnalysedChannel;
using analysis::AnalysedFile;
using analysis::LevelReference;
using signal::SpectralLine;

constexpr std::size_t max_cepstral_peaks = 5;
constexpr const char* quantities[] = {"acceleration", "velocity", "displacement"};

/// A channel with its record.
struct Channel {
    const AnalysedChannel* of;
    const FileSpectrum* record;

    const AnalysedFile& file() const { return record->file; }
    const signal::VibrationReport& report() const { return of->report; }
    LevelReference reference() const { return analysis::level_reference(file().calibration); }
    double db(double power) const { return reference().db(power); }
    std::string text(const SpectralLine& l) const { return fmt::format("{:.2f} ({:.1f})", l.frequency, db(l.power)); }
    /// rms of a channel: of its samples, or by Parseval of the spectrum alone.
    double rms() const {
        if (!file().only_psd) return report().level.rms();
        const signal::Spectrum& psd = report().psd;
        double sum = 0.0;
        for (const double power : psd.power) sum += power;
        return std::sqrt(sum * psd.df * (file().is_density ? 1.0 : 1.0 / psd.noise_bandwidth));
    }
};

/// A mean square with the frequency it belongs to, in the unit of a channel.
struct Level {
    Channel channel;
    double hz, power;
    std::optional<double> deviation_db{};

    double rms() const { return std::sqrt(power); }
    double rms_db() const { return channel.db(power); }
    double db() const { return signal::decibels(power); }
};

struct Line {
    Level level;
    double snr_db;
    std::string name{};
};

Line line_of(const Channel& channel, const SpectralLine& l, std::string name = {}) {
    return {{channel, l.frequency, l.power}, l.snr_db, std::move(name)};
}

/// hz, rms, rms_db, db.
const Fields<Level>& level_fields() {
    static const Fields<Level> all = Fields<Level>("level at a frequency")
                                         .number("hz", "frequency", fixed(3, "Hz"), &Level::hz)
                                         .number("rms", "", significant(4), &Level::rms)
                                         .number("rms_db", "rms", fixed(1, "dB"), &Level::rms_db)
                                         .number("db", "", fixed(1, "dB"), &Level::db);
    return all;
}

const Fields<Line>& line_fields() {
    static const Fields<Line> all = Fields<Line>("line of a spectrum")
                                        .text("", "line", &Line::name)
                                        .part(level_fields(), [](const Line& l) -> const Level& { return l.level; })
                                        .number("snr_db", "SNR", fixed(1, "dB"), &Line::snr_db);
    return all;
}

std::vector<Line> lines_of(const Channel& c, const std::vector<SpectralLine>& lines) {
    std::vector<Line> all;
    for (const SpectralLine& l : lines) all.push_back(line_of(c, l));
    return all;
}

/// Orders, mains hum, other lines and lines of the envelope, each named.
std::vector<Line> named_lines(const Channel& c) {
    const signal::VibrationReport& r = c.report();
    std::vector<Line> all;
    const auto is_named = [&, &lines = all](const SpectralLine& l) {
        return std::ranges::any_of(
            lines, [&](const Line& other) { return std::abs(other.level.hz - l.frequency) < r.lines.df; });
    };
    const signal::FundamentalEstimate& f = r.fundamental;
    const bool may_be_hum = f.may_be_hum || (!f.is_certain() && signal::is_mains_order(f.frequency));
    for (const signal::Harmonic& h : r.harmonics)
        if (h.present)
            all.push_back(line_of(
                c, h,
                may_be_hum ? analysis::uncertain_order(h.order, f.frequency) : fmt::format("order {}", h.order)));
    for (const signal::HumLine& h : r.hum)
        if (!is_named(h))
            all.push_back(line_of(c, h,
                                  f.is_certain() ? fmt::format("hum, {} × {} Hz", h.order, h.mains)
                                                 : analysis::uncertain_order(h.order, h.mains)));
    for (const SpectralLine& l : r.peaks)
        if (!is_named(l)) all.push_back(line_of(c, l));
    for (const SpectralLine& l : r.envelope) all.push_back(line_of(c, l, "of the envelope"));
    return all;
}

struct HarmonicOf {
    Line line;
    const signal::Harmonic* harmonic;
    double fundamental, first_db;  ///< Hz; level of the first order
};

const Fields<HarmonicOf>& harmonic_fields() {
    using H = HarmonicOf;
    static const Fields<H> all =
        Fields<H>("harmonic of the fundamental")
            .integer("order", "", [](const H& h) { return h.harmonic->order; })
            .part(line_fields(), [](const H& h) -> const Line& { return h.line; })
            .number("db_re_first", "", fixed(1, "dB"), [](const H& h) { return h.line.level.db() - h.first_db; })
            .number("deviation_hz", "", fixed(3, "Hz"),
                    [](const H& h) { return h.line.level.hz - h.harmonic->order * h.fundamental; })
            .flag("present", "", [](const H& h) { return h.harmonic->present; });
    return all;
}

std::vector<HarmonicOf> harmonics_of(const Channel& c) {
    const signal::VibrationReport& r = c.report();
    std::vector<HarmonicOf> all;
    for (const signal::Harmonic& h : r.harmonics)
        all.push_back({line_of(c, h), &h, r.fundamental.frequency, signal::decibels(r.harmonics.front().power)});
    return all;
}

struct Hum {
    Line line;
    const signal::HumLine* hum;
};

const Fields<Hum>& hum_fields() {
    static const Fields<Hum> all = Fields<Hum>("line of mains hum")
                                       .part(line_fields(), [](const Hum& h) -> const Line& { return h.line; })
                                       .integer("mains_hz", "", [](const Hum& h) { return h.hum->mains; })
                                       .integer("order", "", [](const Hum& h) { return h.hum->order; });
    return all;
}

/// `has_db`: with the level re 1 of the unit.
Fields<Level> band_fields(const char* about, bool has_db) {
    Fields<Level> all(about);
    all.number("hz", "third octave", significant(4, "Hz"), &Level::hz)
        .number("rms", "", significant(4), &Level::rms)
        .number("rms_db", "rms", fixed(1, "dB"), &Level::rms_db);
    if (has_db) all.number("db", "", fixed(1, "dB"), &Level::db);
    all.number("deviation_db", "±", fixed(2, "dB"), &Level::deviation_db);
    return all;
}

const Fields<signal::CepstralPeak>& cepstrum_fields() {
    using P = signal::CepstralPeak;
    static const Fields<P> all = Fields<P>("peak of the cepstrum")
                                     .number("quefrency_s", "", fixed(2, "ms", "s"), &P::quefrency)
                                     .number("hz", "", fixed(2, "Hz"), &P::frequency)
                                     .number("value", "", significant(4), &P::value);
    return all;
}

std::vector<signal::CepstralPeak> cepstral_peaks_of(const Channel& c) {
    return signal::cepstral_peaks(c.report().cepstrum, max_cepstral_peaks);
}

const Fields<signal::HarmonicSum>& rival_fields() {
    using R = signal::HarmonicSum;
    static const Fields<R> all = Fields<R>("other fundamental that is possible")
                                     .number("hz", "", fixed(1, "Hz"), &R::frequency)
                                     .number("score", "", significant(4), &R::score);
    return all;
}

std::optional<double> if_positive(double value) { return value > 0.0 ? std::optional(value) : std::nullopt; }

const Fields<signal::FundamentalEstimate>& fundamental_fields() {
    using F = signal::FundamentalEstimate;
    static const Fields<F> all =
        Fields<F>("estimate of the fundamental")
            .flag("certain", "", &F::is_certain)
            .flag("may_be_hum", "", &F::may_be_hum)
            .flag("steady", "", &F::steady)
            .range("range_hz", "", fixed(3, "Hz"), [](const F& f) { return std::optional(std::pair(f.low, f.high)); })
            .number("deviation_hz", "", fixed(3, "Hz"), [](const F& f) { return if_positive(f.deviation); })
            .number("periods", "", significant(4), &F::periods)
            .rows("rivals", "", rival_fields(), &F::rivals);
    return all;
}

std::string fundamental_text(const Channel& c) {
    const signal::FundamentalEstimate& f = c.report().fundamental;
    if (!(f.frequency > 0.0)) return "none";
    std::string text = fmt::format("{:.3f} Hz, confidence {:.2f}{}", f.frequency, f.confidence,
                                   f.is_certain()   ? ""
                                   : f.may_be_hum ? ", uncertain: it may be mains hum"
                                                  : ", uncertain");
    for (const signal::HarmonicSum& rival : f.rivals)
        text += fmt::format("{} {:.1f}", &rival == f.rivals.data() ? "; or" : ",", rival.frequency);
    return text;
}

template <class Range, class Text>
std::string joined(const Range& range, Text text) {
    std::vector<std::string> all;
    for (const auto& one : range) all.push_back(text(one));
    return fmt::format("{}", fmt::join(all, " "));
}

std::string orders_text(const Channel& c) {
    return joined(c.report().harmonics, [&](const signal::Harmonic& h) {
        return fmt::format("{} {}", h.order, h.present ? fmt::format("{:.1f}", c.db(h.power)) : "–");
    });
}

std::vector<std::string> hum_lines(const Channel& c) {
    std::vector<std::string> all;
    for (const signal::HumLine& h : c.report().hum)
        all.push_back(fmt::format("of {} Hz mains{} at {:.2f} Hz, {:.1f} dB rms, SNR {:.0f} dB", h.mains,
                                  c.report().fundamental.is_certain() ? "" : ", or a machine,", h.frequency,
                                  c.db(h.power), h.snr_db));
    return all;
}

std::string cepstrum_text(const Channel& c) {
    if (!c.record->method->cepstrum) return {};
    const std::vector<signal::CepstralPeak> peaks = cepstral_peaks_of(c);
    if (peaks.empty()) return "no family of lines";
    return joined(peaks, [](const signal::CepstralPeak& p) {
        return fmt::format("{:.2f} ({:.2f} Hz)", 1e3 * p.quefrency, p.frequency());
    });
}

/// A mark in the spectrum or in that of the envelope; no level: outside of it.
struct MarkIn {
    Channel channel;
    const analysis::MarkLevel* level;
    const analysis::MarkPlace* place;
    bool is_of_envelope = false;

    SpectralLine line() const { return level->line; }
};

const analysis::MarkLevel* level_at(const std::vector<analysis::MarkLevel>& levels, const analysis::MarkPlace& place) {
    const auto found = std::ranges::find_if(levels, [&](const analysis::MarkLevel& one) {
        return one.place.frequency == place.frequency && one.place.label == place.label;
    });
    return found == levels.end() ? nullptr : &*found;
}

std::string mark_text(const MarkIn& m) {
    if (!m.level) return "outside of the spectrum";
    const SpectralLine& line = m.level->line;
    if (m.level->is_line)
        return fmt::format("{:.1f} dB rms at {:.2f} Hz, SNR {:.0f} dB", m.channel.db(line.power), line.frequency,
                           line.snr_db);
    const std::string text =
        fmt::format("no line, {:.1f} dB rms within {:.2f} Hz", m.channel.db(line.power), m.level->within);
    if (!m.level->nearest) return text + "; there is no line";
    const double offset = m.level->nearest->frequency - m.place->frequency;
    if (std::abs(offset) > 0.5 * m.place->frequency) return text + "; no line near";
    return fmt::format("{}; nearest line {:.2f} Hz, {:.2f} Hz {}, {:.1f} dB rms", text, m.level->nearest->frequency,
                       std::abs(offset), offset < 0.0 ? "lower" : "higher", m.channel.db(m.level->nearest->power));
}

std::vector<MarkIn> marks_of(const Channel& c) {
    std::vector<MarkIn> all;
    for (const analysis::MarkPlace& place : c.file().marks)
        all.push_back({c, level_at(c.of->marks, place), &place, false});
    if (c.file().envelope)
        for (const analysis::MarkPlace& place : c.file().marks)
            all.push_back({c, level_at(c.of->envelope_marks, place), &place, true});
    return all;
}

std::vector<std::string> mark_lines(const Channel& c) {
    std::vector<std::string> all;
    for (const MarkIn& m : marks_of(c))
        all.push_back(fmt::format("{} at {:.2f} Hz{}: {}", m.place->name(), m.place->frequency,
                                  m.is_of_envelope ? " of the envelope" : "", mark_text(m)));
    return all;
}

const Fields<MarkIn>& mark_row_fields() {
    static const Fields<MarkIn> all =
        Fields<MarkIn>("marked frequency")
            .text("", "mark", [](const MarkIn& m) { return m.place->name(); })
            .number("", "at", fixed(2, "Hz"), [](const MarkIn& m) { return m.place->frequency; })
            .text("", "in", [](const MarkIn& m) { return m.is_of_envelope ? "envelope" : "spectrum"; })
            .text("", "found", mark_text);
    return all;
}

struct Nearest {
    Line line;
    double offset;  ///< Hz
};

const Fields<Nearest>& nearest_fields() {
    static const Fields<Nearest> all = Fields<Nearest>("line nearest to a mark")
                                           .part(line_fields(), [](const Nearest& n) -> const Line& { return n.line; })
                                           .number("offset_hz", "", fixed(2, "Hz"), &Nearest::offset);
    return all;
}

const Fields<MarkIn>& mark_level_fields() {
    static const Fields<MarkIn> all =
        Fields<MarkIn>("level at a marked frequency")
            .part(line_fields(), [](const MarkIn& m) { return line_of(m.channel, m.level->line); })
            .flag("is_line", "", [](const MarkIn& m) { return m.level->is_line; })
            .number("within_hz", "", fixed(2, "Hz"), [](const MarkIn& m) { return m.level->within; })
            .child("nearest_line", "", nearest_fields(), [](const MarkIn& m) {
                return m.level->nearest ? std::optional(Nearest{line_of(m.channel, *m.level->nearest),
                                                                m.level->nearest->frequency - m.place->frequency})
                                        : std::nullopt;
            });
    return all;
}

/// A mark, for JSON: in both spectra.
struct MarkOf {
    Channel channel;
    const analysis::MarkPlace* place;

    std::optional<MarkIn> in(const std::vector<analysis::MarkLevel>& levels) const {
        const analysis::MarkLevel* level = level_at(levels, *place);
        return level ? std::optional(MarkIn{channel, level, place}) : std::nullopt;
    }
};

Fields<MarkOf> mark_fields(bool has_envelope) {
    Fields<MarkOf> all("marked frequency");
    all.text("label", "", [](const MarkOf& m) { return m.place->label; })
        .integer("harmonic", "", [](const MarkOf& m) { return m.place->harmonic; })
        .number("hz", "", fixed(2, "Hz"), [](const MarkOf& m) { return m.place->frequency; })
        .child("spectrum", "", mark_level_fields(), [](const MarkOf& m) { return m.in(m.channel.of->marks); });
    if (has_envelope)
        all.child("envelope", "", mark_level_fields(),
                  [](const MarkOf& m) { return m.in(m.channel.of->envelope_marks); });
    return all;
}

const Fields<MarkOf>& marks_fields() {
    static const Fields<MarkOf> with_envelope = mark_fields(true);
    static const Fields<MarkOf> all = mark_fields(false).otherwise(
        [](const MarkOf& m) { return m.channel.report().envelope_spectrum.has_value(); }, with_envelope);
    return all;
}

/// name, rms, level, unit: what every channel has.
const Fields<Channel>& channel_level_fields() {
    static const Fields<Channel> all =
        Fields<Channel>("level of a channel")
            .titled([](const Channel& c) { return "channel " + c.of->name; })
            .text("name", "", [](const Channel& c) { return c.of->name; })
            .number("rms", "rms", prefixed(4),
                    [](const Channel& c) { return Number(c.rms(), c.file().calibration.unit); })
            .number("rms_db", "level", fixed(2, "dB"), [](const Channel& c) { return c.db(c.rms() * c.rms()); })
            .text("db_re", "", [](const Channel& c) { return c.reference().text; })
            .text("unit", "", [](const Channel& c) { return c.file().calibration.unit; })
            .flag("calibrated", "", [](const Channel& c) { return c.file().calibration.known; })
            .text("", "calibration", [](const Channel& c) {
                return c.file().calibration.known ? std::string() : std::string("uncalibrated");
            });
    return all;
}

const Channel& same(const Channel& c) { return c; }

const Fields<Channel>& psd_channel_fields() {
    static const Fields<Channel> all =
        Fields<Channel>("level of a channel by its spectrum")
            .part(channel_level_fields(), same)
            .text("", "by",
                  [](const Channel& c) { return fmt::format("the spectrum of {} segments", c.report().psd.segments); });
    return all;
}

/// Of the report of a channel.
template <class Read>
auto of_report(Read read) {
    return [read](const Channel& c) { return std::invoke(read, c.report()); };
}

const Fields<Channel>& channel_fields() {
    using R = signal::VibrationReport;
    static const Fields<Level> third = band_fields("level of a third octave", true),
                               filtered = band_fields("level of an octave filter", false);
    const auto bands = [](const Channel& c) {
        std::vector<Level> all;
        for (const signal::Band& b : c.report().bands)
            all.push_back({c, b.centre, b.power, analysis::band_deviation(b, c.report().lines)});
        return all;
    };
    static const Fields<Channel> all =
        Fields<Channel>("analysis of a channel")
            .warnings("warnings", [](const Channel& c) { return c.of->warnings; })
            .part(channel_level_fields(), same)
            .number("crest", "crest", fixed(2), of_report([](const R& r) { return r.level.crest(); }))
            .number("mean", "", significant(4), of_report([](const R& r) { return r.level.mean(); }))
            .number("peak", "", significant(4), of_report([](const R& r) { return r.level.peak(); }))
            .integer("clipped", "", of_report([](const R& r) { return r.level.clipped(); }))
            .number("kurtosis", "kurtosis", fixed(2), of_report([](const R& r) { return r.moments.kurtosis(); }))
            .number("skewness", "skewness", fixed(2), of_report([](const R& r) { return r.moments.skewness(); }))
            .number("machine_velocity_rms", "velocity 10 to 1000 Hz (ISO 20816), rms", prefixed(4, "m/s"),
                    [](const Channel& c) { return c.of->machine_velocity; })
            .number("machine_velocity_coverage", "", fixed(3),
                    [](const Channel& c) { return c.of->machine_velocity_coverage; })
            .text("", "fundamental", fundamental_text)
            .number("fundamental_hz", "", fixed(3, "Hz"),
                    of_report([](const R& r) { return if_positive(r.fundamental.frequency); }))
            .number("confidence", "", fixed(2), of_report([](const R& r) { return r.fundamental.confidence; }))
            .child("fundamental", "", fundamental_fields(),
                   [](const Channel& c) -> const auto& { return c.report().fundamental; })
            .text("", "orders, dB rms", orders_text)
            .number("thd", "THD", significant(3, "%", "1"), of_report(&R::thd))
            .rows("harmonics", "", harmonic_fields(), harmonics_of)
            .rows("peaks", "", line_fields(), [](const Channel& c) { return lines_of(c, c.report().peaks); })
            .text("", "lines, Hz (dB rms)",
                  [](const Channel& c) {
                      return joined(c.report().peaks, [&](const SpectralLine& l) { return c.text(l); });
                  })
            .rows("hum", "", hum_fields(),
                  [](const Channel& c) {
                      std::vector<Hum> all_hum;
                      for (const signal::HumLine& h : c.report().hum) all_hum.push_back({line_of(c, h), &h});
                      return all_hum;
                  })
            .notes("", "hum", hum_lines)
            .rows("envelope", "", line_fields(), [](const Channel& c) { return lines_of(c, c.report().envelope); })
            .text("", "envelope, Hz (dB rms)",
                  [](const Channel& c) {
                      return joined(c.report().envelope, [&](const SpectralLine& l) { return c.text(l); });
                  })
            .rows("filtered_bands", "", filtered,
                  [](const Channel& c) {
                      std::vector<Level> levels;
                      for (const signal::FilteredBand& b : c.report().filtered)
                          levels.push_back({c, b.centre, b.power, b.deviation_db});
                      return levels;
                  })
            .omitted()
            .text("", "octave filters, Hz (dB rms)",
                  [](const Channel& c) {
                      return joined(c.report().filtered, [&](const signal::FilteredBand& b) {
                          return fmt::format("{:.4g} ({:.1f})", b.centre, c.db(b.power));
                      });
                  })
            .rows("cepstrum", "", cepstrum_fields(), cepstral_peaks_of)
            .text("", "cepstrum, ms (spacing)", cepstrum_text)
            .rows("marks", "", marks_fields(),
                  [](const Channel& c) {
                      std::vector<MarkOf> marks;
                      for (const analysis::MarkPlace& place : c.file().marks) marks.push_back({c, &place});
                      return marks;
                  })
            .omitted()
            .notes("", "mark", mark_lines)
            .rows("", "marks", mark_row_fields(), marks_of)
            .on_pages()
            .rows("", "lines", line_fields(), named_lines)
            .on_pages()
            .rows("bands", "third octaves", third, bands)
            .on_pages()
            .otherwise([](const Channel& c) { return c.file().only_psd; }, psd_channel_fields());
    return all;
}

const Fields<FileSpectrum>& integration_fields() {
    static const Fields<FileSpectrum> all =
        Fields<FileSpectrum>("integration before the analysis")
            .text("to", "", [](const FileSpectrum& f) { return std::string(quantities[f.file.integrations]); })
            .number("high_pass_hz", "", significant(4, "Hz"), [](const FileSpectrum& f) { return f.file.high_pass; });
    return all;
}

const signal::Spectrum& psd_of(const FileSpectrum& f) { return f.file.channels.front().report.psd; }

const Fields<FileSpectrum>& psd_fields() {
    using F = FileSpectrum;
    static const Fields<F> all =
        Fields<F>("spectrum")
            .number("df_hz", "", significant(4, "Hz"), [](const F& f) { return psd_of(f).df; })
            .text("units", "",
                  [](const F& f) {
                      return fmt::format("({})^2{}", f.file.calibration.unit,
                                         f.method->scaling == "density" ? "/Hz" : "");
                  })
            .number("enbw_hz", "", significant(4, "Hz"), [](const F& f) { return psd_of(f).noise_bandwidth; })
            .text("window", "", [](const F& f) { return f.method->window; })
            .integer("segment", "", [](const F& f) { return f.file.psd.segment; })
            .integer("overlap", "", [](const F& f) { return f.file.psd.overlap; })
            .text("detrend", "", [](const F& f) { return f.method->detrend; })
            .text("average", "", [](const F& f) { return f.method->average; })
            .integer("segments", "", [](const F& f) { return psd_of(f).segments; })
            .number("relative_deviation", "", significant(4), [](const F& f) { return psd_of(f).relative_deviation(); })
            .number("lines_df_hz", "", significant(4, "Hz"),
                    [](const F& f) {
                        return f.file.only_psd ? std::nullopt : std::optional(f.file.channels.front().report.lines.df);
                    })
            .omitted();
    return all;
}

const Fields<FileSpectrum>& file_fields() {
    using F = FileSpectrum;
    static const Fields<F> all =
        Fields<F>("spectral analysis of a record")
            .titled([](const F& f) {
                return fmt::format("{}: {:.3f} s at {}, {}", f.file.file.string(), f.file.duration,
                                   readable(f.file.rate, "Hz", 6), counted(f.file.channels.size(), "channel"));
            })
            .figure(
                "spectra and spectrogram", [](const F& f) { return !f.file.only_psd; },
                [](const F& f) { return draw_spectrum(f.file, f.method->band); })
            .text("file", "", [](const F& f) { return f.file.file.string(); })
            .number("sample_rate_hz", "", prefixed(6, "Hz"), [](const F& f) { return f.file.rate; })
            .number("duration_s", "", fixed(3, "s"), [](const F& f) { return f.file.duration; })
            .text("", "levels",
                  [](const F& f) { return "rms, dB re " + analysis::level_reference(f.file.calibration).text; })
            .text("", "segments",
                  [](const F& f) {
                      return f.file.channels.empty()
                                 ? std::string()
                                 : fmt::format("{} of {} samples", psd_of(f).segments, f.file.psd.segment);
                  })
            .part(record_fields(),
                  [](const F& f) { return ReadRecord{f.file.stretch, f.file.recorded, f.file.log, f.file.rate}; })
            .omitted()
            .text("", "integrated to",
                  [](const F& f) {
                      return f.file.integrations == 0
                                 ? std::string()
                                 : fmt::format("{}, high-pass {} of second order{}", quantities[f.file.integrations],
                                               readable(f.file.high_pass, "Hz"),
                                               f.file.integrations > 1 ? ", twice" : "");
                  })
            .child("integrated", "", integration_fields(),
                   [](const F& f) { return f.file.integrations > 0 ? &f : nullptr; })
            .omitted()
            .children("channels", "channel", channel_fields(),
                      [](const F& f) {
                          std::vector<Channel> channels;
                          for (const AnalysedChannel& one : f.file.channels) channels.push_back({&one, &f});
                          return channels;
                      })
            .child("psd", "", psd_fields(), [](const F& f) { return f.file.channels.empty() ? nullptr : &f; })
            .omitted();
    return all;
}

std::vector<std::string> methods(const Spectra& s) {
    const SpectrumMethod& m = *s.method;
    std::vector<std::string> all{
        fmt::format("Curves: Welch, window {}, overlap {:g} %, detrend {}, average {}, scaling {}.", m.window,
                    100.0 * m.overlap, m.detrend, m.average, m.scaling),
        "Lines and bands: Welch, Hann, half overlapping, mean of each segment removed. Between bins by the ratio of "
        "the two strongest (Hann); SNR over the median of the bins 4 to 16 away. Levels are of the root mean "
        "square. A line needs an SNR that a noise bin exceeds once in a million.",
        fmt::format("Fundamental from {} Hz: harmonic sums of half seconds, joined to a path over time, and of the "
                    "whole record; uncertain below a confidence of 0.25.",
                    m.fundamental),
        "Third octaves have centres 10^(n/10) Hz; ± is one standard deviation of noise in the band."};
    if (!m.envelope.empty()) all.push_back(fmt::format("Envelope of the band {} Hz.", m.envelope));
    return all;
}

}  // namespace

Result spectrum_result(const AnalysedFile& file, const SpectrumMethod& method, bool keeps_figure) {
    const FileSpectrum analysed{file, &method};
    Result result = file_fields().of(analysed);
    settle_pictures(result, keeps_figure);
    return result;
}

Result unread_spectrum(const std::string& file, const std::string& error) {
    return tried_fields(file_fields()).of({file, nullptr, error});
}

const std::vector<std::string> spectrum_columns{"file",       "channel", "sample_rate_hz", "duration_s",
                                                "rms",        "unit",    "crest",          "fundamental_hz",
                                                "confidence", "hum_hz",  "warnings",       "error"};

std::vector<file::Json> spectrum_rows(const AnalysedFile& file, const SpectrumMethod& method) {
    const FileSpectrum analysed{file, &method};
    std::vector<file::Json> rows;
    for (const AnalysedChannel& c : file.channels) {
        file::Json row = json_of(channel_fields().of({&c, &analysed}));
        row["file"] = file.file.string();
        row["channel"] = c.name;
        row["sample_rate_hz"] = file.rate;
        row["duration_s"] = file.duration;
        row["hum_hz"] =
            joined(c.report.hum, [](const signal::HumLine& h) { return fmt::format("{:.2f}", h.frequency); });
        row["warnings"] = fmt::format("{}", fmt::join(c.warnings, "; "));
        rows.push_back(std::move(row));
    }
    return rows;
}

const Fields<Spectra>& spectrum_fields() {
    static const Fields<Spectra> all = Fields<Spectra>("spectral analysis of records")
                                           .results("rows", "record", tried_fields(file_fields()), &Spectra::records)
                                           .notes("", "Methods", methods)
                                           .on_pages();
    return all;
}

}  // namespace tactus::report
