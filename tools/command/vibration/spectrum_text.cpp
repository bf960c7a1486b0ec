// SPDX-License-Identifier: Apache-2.0
#include "tools/command/vibration/spectrum_text.hpp"

#include "assets/file/json.hpp"
#include "tools/command/batch.hpp"
#include "tools/counted.hpp"
#include "tools/study/vibration/level_reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tactus::command {

using file::Json;
using study::AnalysedChannel;
using study::AnalysedFile;
using study::band_deviation;
using study::decibels;

namespace {

std::string power_unit(const AnalysedFile& file, bool density) {
    return fmt::format("({})^2{}", file.calibration.unit, density ? "/Hz" : "");
}

Json number_or_null(double value) { return value > 0.0 ? Json(value) : Json(nullptr); }

Json channel_json(const AnalysedChannel& channel, const AnalysedFile& file) {
    const signal::VibrationReport& r = channel.report;
    const study::LevelReference reference = study::level_reference(file.calibration);
    Json json{{"name", channel.name},
              {"rms", r.level.rms()},
              {"rms_db", reference.db(r.level.rms() * r.level.rms())},
              {"db_re", reference.text},
              {"crest", r.level.crest()},
              {"mean", r.level.mean()},
              {"peak", r.level.peak()},
              {"clipped", r.level.clipped()},
              {"unit", file.calibration.unit},
              {"calibrated", file.calibration.known},
              {"fundamental_hz", number_or_null(r.fundamental.frequency)},
              {"confidence", r.fundamental.confidence},
              {"fundamental",
               {{"certain", r.fundamental.is_certain()},
                {"steady", r.fundamental.steady},
                {"range_hz", {r.fundamental.low, r.fundamental.high}},
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
    return json;
}

}  // namespace

std::string analysis_json(const AnalysedFile& file, const SpectrumWords& words) {
    Json json{{"file", file.file.string()}, {"sample_rate_hz", file.rate}, {"duration_s", file.duration}};
    if (file.log)
        json["log"] = {{"rows", file.log->rows},
                       {"lost_rows", file.log->lost_rows},
                       {"gaps", file.log->gaps},
                       {"lost_s", file.log->lost_seconds},
                       {"step_s", {file.log->shortest_step, file.log->longest_step}},
                       {"nyquist_hz", 0.5 * file.rate},
                       {"usable_hz", file.log->usable}};
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
                       {"relative_deviation", psd.relative_deviation()},
                       {"lines_df_hz", file.channels.front().report.lines.df}};
    }
    return json.dump(2) + "\n";
}

std::string analysis_text(const AnalysedFile& file) {
    std::string text = fmt::format("{}: {:.3f} s at {:.6g} Hz, {}\n", file.file.string(), file.duration, file.rate,
                                   counted(file.channels.size(), "channel"));
    auto out = std::back_inserter(text);
    const study::LevelReference reference = study::level_reference(file.calibration);
    fmt::format_to(out, "  levels: rms, dB re {}\n", reference.text);
    if (file.log)
        fmt::format_to(out,
                       "  uneven log, {} rows, steps {:.3g} to {:.3g} ms: resampled; limited to {:.4g} Hz, reliable to "
                       "about {:.3g} Hz; faster vibration is aliased\n",
                       file.log->rows, 1e3 * file.log->shortest_step, 1e3 * file.log->longest_step, 0.5 * file.rate,
                       file.log->usable);
    for (const AnalysedChannel& channel : file.channels) {
        const signal::VibrationReport& r = channel.report;
        const auto list = [&](const char* name, const std::vector<signal::SpectralLine>& lines) {
            if (lines.empty()) return;
            fmt::format_to(out, "    {}, Hz (dB rms):", name);
            for (const signal::SpectralLine& l : lines)
                fmt::format_to(out, " {:.2f} ({:.1f})", l.frequency, reference.db(l.power));
            text += '\n';
        };
        fmt::format_to(out, "  channel {}: rms {:.4g} {}{}, {:.2f} dB; crest {:.2f}\n", channel.name, r.level.rms(),
                       file.calibration.unit, file.calibration.known ? "" : " (uncalibrated)",
                       reference.db(r.level.rms() * r.level.rms()), r.level.crest());
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
            text += '\n';
        }
        list("lines", r.peaks);
        for (const signal::HumLine& h : r.hum)
            fmt::format_to(out, "    hum of {} Hz mains at {:.2f} Hz, {:.1f} dB rms, SNR {:.0f} dB\n", h.mains,
                           h.frequency, reference.db(h.power), h.snr_db);
        list("envelope", r.envelope);
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
