// SPDX-License-Identifier: Apache-2.0
#include "tools/command/vibration/spectrum_text.hpp"

#include "assets/file/json.hpp"
#include "dsp/core/readable.hpp"
#include "dsp/signal/spectrum/decibels.hpp"
#include "tools/analysis/vibration/level_reference.hpp"
#include "tools/command/batch.hpp"
#include "tools/command/vibration/record_json.hpp"
#include "tools/command/vibration/stretch_options.hpp"
#include "tools/counted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tactus::command {

using analysis::AnalysedChannel;
using analysis::AnalysedFile;
using analysis::band_deviation;
using file::Json;
using signal::decibels;

namespace {

std::string power_unit(const AnalysedFile& file, bool density) {
    return fmt::format("({})^2{}", file.calibration.unit, density ? "/Hz" : "");
}

/// rms of a channel: of its samples, or by Parseval of the spectrum alone.
double rms_of(const AnalysedChannel& channel, const AnalysedFile& file) {
    if (!file.only_psd) return channel.report.level.rms();
    const signal::Spectrum& psd = channel.report.psd;
    double sum = 0.0;
    for (const double power : psd.power) sum += power;
    return std::sqrt(sum * psd.df * (file.is_density ? 1.0 : 1.0 / psd.noise_bandwidth));
}

constexpr std::size_t max_cepstral_peaks = 5;
constexpr const char* quantities[] = {"acceleration", "velocity", "displacement"};

Json number_or_null(double value) { return value > 0.0 ? Json(value) : Json(nullptr); }

Json channel_json(const AnalysedChannel& channel, const AnalysedFile& file) {
    const signal::VibrationReport& r = channel.report;
    const analysis::LevelReference reference = analysis::level_reference(file.calibration);
    if (file.only_psd) {
        const double rms = rms_of(channel, file);
        return {{"name", channel.name},
                {"rms", rms},
                {"rms_db", reference.db(rms * rms)},
                {"db_re", reference.text},
                {"unit", file.calibration.unit},
                {"calibrated", file.calibration.known}};
    }
    Json json{{"name", channel.name},
              {"rms", r.level.rms()},
              {"rms_db", reference.db(r.level.rms() * r.level.rms())},
              {"db_re", reference.text},
              {"crest", r.level.crest()},
              {"mean", r.level.mean()},
              {"peak", r.level.peak()},
              {"clipped", r.level.clipped()},
              {"skewness", r.moments.skewness()},
              {"kurtosis", r.moments.kurtosis()},
              {"thd", r.thd ? Json(*r.thd) : Json()},
              {"machine_velocity_rms", channel.machine_velocity ? Json(*channel.machine_velocity) : Json()},
              {"cepstrum", Json::array()},
              {"unit", file.calibration.unit},
              {"calibrated", file.calibration.known},
              {"fundamental_hz", number_or_null(r.fundamental.frequency)},
              {"confidence", r.fundamental.confidence},
              {"fundamental",
               {{"certain", r.fundamental.is_certain()},
                {"steady", r.fundamental.steady},
                {"range_hz", {r.fundamental.low, r.fundamental.high}},
                {"deviation_hz", number_or_null(r.fundamental.deviation)},
                {"periods", r.fundamental.periods},
                {"rivals", Json::array()}}},
              {"harmonics", Json::array()},
              {"peaks", Json::array()},
              {"hum", Json::array()},
              {"bands", Json::array()},
              {"envelope", Json::array()},
              {"warnings", channel.warnings}};
    for (const signal::HarmonicSum& rival : r.fundamental.rivals)
        json["fundamental"]["rivals"].push_back({{"hz", rival.frequency}, {"score", rival.score}});
    const auto line = [&](const signal::SpectralLine& l) {
        return Json{{"hz", l.frequency},
                    {"rms", std::sqrt(l.power)},
                    {"rms_db", reference.db(l.power)},
                    {"db", decibels(l.power)},
                    {"snr_db", l.snr_db}};
    };
    const double first = r.harmonics.empty() ? 0.0 : decibels(r.harmonics.front().power);
    for (const signal::Harmonic& h : r.harmonics) {
        Json row{{"order", h.order}};
        row.update(line(h));
        row["db_re_first"] = decibels(h.power) - first;
        row["deviation_hz"] = h.frequency - h.order * r.fundamental.frequency;
        row["present"] = h.present;
        json["harmonics"].push_back(row);
    }
    for (const signal::SpectralLine& l : r.peaks) json["peaks"].push_back(line(l));
    for (const signal::HumLine& l : r.hum) {
        Json row = line(l);
        row["mains_hz"] = l.mains;
        row["order"] = l.order;
        json["hum"].push_back(row);
    }
    for (const signal::Band& b : r.bands)
        json["bands"].push_back({{"hz", b.centre},
                                 {"rms", std::sqrt(b.power)},
                                 {"rms_db", reference.db(b.power)},
                                 {"db", decibels(b.power)},
                                 {"deviation_db", band_deviation(b, r.lines)}});
    for (const signal::SpectralLine& l : r.envelope) json["envelope"].push_back(line(l));
    for (const signal::CepstralPeak& peak : signal::cepstral_peaks(r.cepstrum, max_cepstral_peaks))
        json["cepstrum"].push_back({{"quefrency_s", peak.quefrency}, {"hz", peak.frequency()}, {"value", peak.value}});
    if (!r.filtered.empty()) json["filtered_bands"] = Json::array();
    for (const signal::FilteredBand& b : r.filtered)
        json["filtered_bands"].push_back({{"hz", b.centre},
                                          {"rms", std::sqrt(b.power)},
                                          {"rms_db", reference.db(b.power)},
                                          {"deviation_db", b.deviation_db}});
    if (!file.marks.empty()) json["marks"] = Json::array();
    for (const analysis::MarkPlace& place : file.marks) {
        Json row{{"label", place.label}, {"harmonic", place.harmonic}, {"hz", place.frequency}};
        const auto add = [&](const char* of, const std::vector<analysis::MarkLevel>& levels) {
            row[of] = nullptr;  // outside of the spectrum
            for (const analysis::MarkLevel& level : levels) {
                if (level.place.frequency != place.frequency || level.place.label != place.label) continue;
                row[of] = line(level.line);
                row[of]["is_line"] = level.is_line;
                row[of]["within_hz"] = level.within;
                row[of]["nearest_line"] = nullptr;
                if (!level.nearest) continue;
                row[of]["nearest_line"] = line(*level.nearest);
                row[of]["nearest_line"]["offset_hz"] = level.nearest->frequency - place.frequency;
            }
        };
        add("spectrum", channel.marks);
        if (r.envelope_spectrum) add("envelope", channel.envelope_marks);
        json["marks"].push_back(row);
    }
    return json;
}

std::string nearest_text(const analysis::MarkLevel& level, const analysis::LevelReference& reference) {
    if (!level.nearest) return "; there is no line";
    const double offset = level.nearest->frequency - level.place.frequency;
    if (std::abs(offset) > 0.5 * level.place.frequency) return "; no line near";
    return fmt::format("; nearest line {:.2f} Hz, {:.2f} Hz {}, {:.1f} dB rms", level.nearest->frequency,
                       std::abs(offset), offset < 0.0 ? "lower" : "higher", reference.db(level.nearest->power));
}

/// A line per mark and spectrum.
std::string marks_text(const AnalysedChannel& channel, const AnalysedFile& file,
                       const analysis::LevelReference& reference) {
    std::string text;
    const auto add = [&](const char* where, const std::vector<analysis::MarkLevel>& levels) {
        for (const analysis::MarkPlace& place : file.marks) {
            const auto level = std::ranges::find_if(levels, [&](const analysis::MarkLevel& one) {
                return one.place.frequency == place.frequency && one.place.label == place.label;
            });
            text += fmt::format("    {} at {:.2f} Hz{}: ", place.name(), place.frequency, where);
            if (level == levels.end()) {
                text += "outside of the spectrum\n";
                continue;
            }
            if (level->is_line)
                text += fmt::format("{:.1f} dB rms at {:.2f} Hz, SNR {:.0f} dB\n", reference.db(level->line.power),
                                    level->line.frequency, level->line.snr_db);
            else
                text += fmt::format("no line, {:.1f} dB rms within {:.2f} Hz{}\n", reference.db(level->line.power),
                                    level->within, nearest_text(*level, reference));
        }
    };
    add("", channel.marks);
    if (file.envelope) add(" of the envelope", channel.envelope_marks);
    return text;
}

}  // namespace

std::string analysis_json(const AnalysedFile& file, const SpectrumWords& words) {
    Json json{{"file", file.file.string()}, {"sample_rate_hz", file.rate}, {"duration_s", file.duration}};
    json["stretch"] = stretch_json(file.stretch);
    if (file.log) json["log"] = log_json(*file.log, file.rate);
    json["calibration"] = calibration_json(file.recorded);
    if (file.integrations > 0)
        json["integrated"] = {{"to", quantities[file.integrations]}, {"high_pass_hz", file.high_pass}};
    json["channels"] = Json::array();
    for (const AnalysedChannel& channel : file.channels) json["channels"].push_back(channel_json(channel, file));
    if (!file.channels.empty()) {
        const signal::Spectrum& psd = file.channels.front().report.psd;
        json["psd"] = {{"df_hz", psd.df},
                       {"units", power_unit(file, words.scaling == "density")},
                       {"enbw_hz", psd.noise_bandwidth},
                       {"window", words.window},
                       {"segment", file.psd.segment},
                       {"overlap", file.psd.overlap},
                       {"detrend", words.detrend},
                       {"average", words.average},
                       {"segments", psd.segments},
                       {"relative_deviation", psd.relative_deviation()}};
        if (!file.only_psd) json["psd"]["lines_df_hz"] = file.channels.front().report.lines.df;
    }
    return json.dump(2) + "\n";
}

std::string analysis_text(const AnalysedFile& file, const SpectrumWords& words) {
    std::string text = fmt::format("{}: {:.3f} s at {}, {}\n", file.file.string(), file.duration,
                                   readable(file.rate, "Hz", 6), counted(file.channels.size(), "channel"));
    auto out = std::back_inserter(text);
    const analysis::LevelReference reference = analysis::level_reference(file.calibration);
    if (!file.stretch.is_whole()) fmt::format_to(out, "  of the record: {}\n", file.stretch.text());
    fmt::format_to(out, "  levels: rms, dB re {}\n", reference.text);
    for (const std::string& line : analysis::understood(file.recorded, file.log, file.rate))
        fmt::format_to(out, "  {}\n", line);
    if (file.integrations > 0)
        fmt::format_to(out, "  integrated to {}, high-pass {} of second order{}\n", quantities[file.integrations],
                       readable(file.high_pass, "Hz"), file.integrations > 1 ? ", twice" : "");
    for (const AnalysedChannel& channel : file.channels) {
        const signal::VibrationReport& r = channel.report;
        const auto list = [&](const char* name, const std::vector<signal::SpectralLine>& lines) {
            if (lines.empty()) return;
            fmt::format_to(out, "    {}, Hz (dB rms):", name);
            for (const signal::SpectralLine& l : lines)
                fmt::format_to(out, " {:.2f} ({:.1f})", l.frequency, reference.db(l.power));
            text += '\n';
        };
        const double rms = rms_of(channel, file);
        fmt::format_to(out, "  channel {}: rms {}{}, {:.2f} dB", channel.name, readable(rms, file.calibration.unit, 4),
                       file.calibration.known ? "" : " (uncalibrated)", reference.db(rms * rms));
        if (file.only_psd) {
            fmt::format_to(out, " by the spectrum of {} segments\n", r.psd.segments);
            continue;
        }
        fmt::format_to(out, "; crest {:.2f}, kurtosis {:.2f}, skewness {:.2f}\n", r.level.crest(), r.moments.kurtosis(),
                       r.moments.skewness());
        if (channel.machine_velocity)
            fmt::format_to(out, "    velocity {:g} to {:g} Hz (ISO 20816): {} rms\n", analysis::machine_band.first,
                           analysis::machine_band.second, readable(*channel.machine_velocity, "m/s", 4));
        if (r.fundamental.frequency > 0.0) {
            fmt::format_to(out, "    fundamental {:.3f} Hz, confidence {:.2f}{}", r.fundamental.frequency,
                           r.fundamental.confidence, r.fundamental.is_certain() ? "" : ", uncertain");
            for (const signal::HarmonicSum& rival : r.fundamental.rivals)
                fmt::format_to(out, "{} {:.1f}", &rival == r.fundamental.rivals.data() ? "; or" : ",", rival.frequency);
            text += '\n';
        } else {
            text += "    no fundamental\n";
        }
        if (!r.harmonics.empty()) {
            text += "    orders, dB rms:";
            for (const signal::Harmonic& h : r.harmonics)
                fmt::format_to(out, " {}{}", h.order, h.present ? fmt::format(" {:.1f}", reference.db(h.power)) : " –");
            if (r.thd) fmt::format_to(out, "; THD {:.3g} %", 100.0 * *r.thd);
            text += '\n';
        }
        list("lines", r.peaks);
        for (const signal::HumLine& h : r.hum)
            fmt::format_to(out, "    hum of {} Hz mains at {:.2f} Hz, {:.1f} dB rms, SNR {:.0f} dB\n", h.mains,
                           h.frequency, reference.db(h.power), h.snr_db);
        list("envelope", r.envelope);
        if (!r.filtered.empty()) {
            text += "    octave filters, Hz (dB rms):";
            for (const signal::FilteredBand& b : r.filtered)
                fmt::format_to(out, " {:.4g} ({:.1f})", b.centre, reference.db(b.power));
            text += '\n';
        }
        if (words.cepstrum) {
            const std::vector<signal::CepstralPeak> peaks = signal::cepstral_peaks(r.cepstrum, max_cepstral_peaks);
            text += peaks.empty() ? "    cepstrum: no family of lines" : "    cepstrum, ms (spacing):";
            for (const signal::CepstralPeak& peak : peaks)
                fmt::format_to(out, " {:.2f} ({:.2f} Hz)", 1e3 * peak.quefrency, peak.frequency());
            text += '\n';
        }
        text += marks_text(channel, file, reference);
        for (const std::string& warning : channel.warnings) fmt::format_to(out, "    {}\n", warning);
    }
    return text;
}

std::string analysis_csv(const AnalysedFile& file) {
    std::string text = "frequency_hz";
    for (const AnalysedChannel& channel : file.channels) text += "," + channel.name;
    text += '\n';
    const std::size_t bins = file.channels.empty() ? 0 : file.channels.front().report.psd.power.size();
    for (std::size_t k = 0; k < bins; ++k) {
        fmt::format_to(std::back_inserter(text), "{}", file.channels.front().report.psd.frequency(k));
        for (const AnalysedChannel& channel : file.channels)
            fmt::format_to(std::back_inserter(text), ",{}", channel.report.psd.power[k]);
        text += '\n';
    }
    return text;
}

std::string cepstrum_csv(const AnalysedFile& file) {
    std::string text = "quefrency_s";
    for (const AnalysedChannel& channel : file.channels) text += "," + csv_field(channel.name);
    text += '\n';
    const std::size_t values = file.channels.empty() ? 0 : file.channels.front().report.cepstrum.value.size();
    for (std::size_t k = 0; k < values; ++k) {
        fmt::format_to(std::back_inserter(text), "{}", file.channels.front().report.cepstrum.quefrency(k));
        for (const AnalysedChannel& channel : file.channels)
            // A silent channel has none.
            text +=
                k < channel.report.cepstrum.value.size() ? fmt::format(",{}", channel.report.cepstrum.value[k]) : ",";
        text += '\n';
    }
    return text;
}

std::string analysis_rows(const AnalysedFile& file) {
    std::string rows;
    for (const AnalysedChannel& c : file.channels) {
        const signal::VibrationReport& r = c.report;
        std::string hum, warnings;
        for (const signal::HumLine& h : r.hum) hum += fmt::format("{}{:.2f}", hum.empty() ? "" : " ", h.frequency);
        for (const std::string& warning : c.warnings) warnings += (warnings.empty() ? "" : "; ") + warning;
        rows += fmt::format("{},{},{},{},{},{},{},{},{},{},{},\n", csv_field(file.file.string()), csv_field(c.name),
                            file.rate, file.duration, r.level.rms(), csv_field(file.calibration.unit), r.level.crest(),
                            r.fundamental.frequency > 0.0 ? fmt::format("{}", r.fundamental.frequency) : "",
                            r.fundamental.confidence, hum, csv_field(warnings));
    }
    return rows;
}

}  // namespace tactus::command
