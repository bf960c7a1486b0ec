// SPDX-License-Identifier: Apache-2.0
#include "tools/study/vibration/spectrum_analysis.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tactus {

using Json = nlohmann::ordered_json;

namespace {

WelchSettings psd_settings(const SpectrumChoice& choice, double rate, std::size_t frames) {
    WelchSettings settings;
    settings.rate = rate;
    settings.segment =
        std::min(choice.segment.value_or(suggested_segment(rate, frames)), std::max<std::size_t>(1, frames));
    const double overlap = choice.overlap.value_or(0.5);
    settings.overlap =
        std::min(settings.segment - 1, static_cast<std::size_t>(overlap * static_cast<double>(settings.segment)));
    constexpr std::pair<const char*, WindowKind> windows[] = {
        {"hann", WindowKind::hann},         {"hamming", WindowKind::hamming},
        {"blackman", WindowKind::blackman}, {"blackmanharris", WindowKind::blackman_harris},
        {"flattop", WindowKind::flat_top},  {"boxcar", WindowKind::rectangular}};
    for (const auto& [name, kind] : windows)
        if (choice.window == name) settings.window = kind;
    settings.detrend = choice.detrend == "none"     ? Detrend::none
                       : choice.detrend == "linear" ? Detrend::linear
                                                    : Detrend::constant;
    settings.averaging = choice.average == "median" ? Averaging::median
                         : choice.average == "max"  ? Averaging::maximum
                         : choice.average == "min"  ? Averaging::minimum
                                                    : Averaging::mean;
    return settings;
}

std::vector<std::string> warnings_of(const VibrationReport& report, const AnalysedFile& file) {
    std::vector<std::string> warnings;
    const Level& level = report.level;
    if (level.largest() == 0.0) warnings.push_back("the channel is silent");
    else if (level.rms() <= 1e-12 * level.largest()) warnings.push_back("the channel is constant: nothing vibrates");
    if (level.clipped() > 0)
        warnings.push_back(fmt::format(
            "clipped: {} samples in runs at the limit ({:.3g} %); peaks and high orders are wrong", level.clipped(),
            100.0 * static_cast<double>(level.clipped()) / static_cast<double>(level.count())));
    if (report.lines.effective_segments < 4.0)
        warnings.push_back(fmt::format("short: {} segments only, levels of noise are uncertain by {:.1f} dB",
                                       report.lines.segments, 4.34 * report.lines.relative_deviation()));
    if (report.fundamental.frequency > 0.0 && !report.fundamental.steady)
        warnings.push_back(
            fmt::format("the rate wavers between {:.1f} and {:.1f} Hz: lines are smeared, see 'tactus orders'",
                        report.fundamental.low, report.fundamental.high));
    if (file.log && file.log->lost_seconds > 0.0)
        warnings.push_back(fmt::format("{} gaps, {:.3g} s lost", file.log->gaps, file.log->lost_seconds));
    return warnings;
}

std::string power_unit(const AnalysedFile& file, bool density) {
    return fmt::format("({})^2{}", file.calibration.unit, density ? "/Hz" : "");
}

Json number_or_null(double value) { return value > 0.0 ? Json(value) : Json(nullptr); }

Json channel_json(const AnalysedChannel& channel, const AnalysedFile& file) {
    const VibrationReport& r = channel.report;
    Json json{{"name", channel.name},
              {"rms", r.level.rms()},
              {"crest", r.level.crest()},
              {"mean", r.level.mean()},
              {"peak", r.level.peak()},
              {"clipped", r.level.clipped()},
              {"unit", file.calibration.unit},
              {"calibrated", file.calibration.known},
              {"fundamental_hz", number_or_null(r.fundamental.frequency)},
              {"confidence", r.fundamental.confidence},
              {"fundamental",
               {{"steady", r.fundamental.steady},
                {"range_hz", {r.fundamental.low, r.fundamental.high}},
                {"rivals", Json::array()}}},
              {"harmonics", Json::array()},
              {"peaks", Json::array()},
              {"hum", Json::array()},
              {"bands", Json::array()},
              {"envelope", Json::array()},
              {"warnings", channel.warnings}};
    for (const CombFit& rival : r.fundamental.rivals)
        json["fundamental"]["rivals"].push_back({{"hz", rival.frequency}, {"score", rival.score()}});
    const auto line = [](const SpectralLine& l) {
        return Json{{"hz", l.frequency}, {"db", decibels(l.power)}, {"snr_db", l.snr_db}};
    };
    const double first = r.harmonics.empty() ? 0.0 : decibels(r.harmonics.front().power);
    for (const Harmonic& h : r.harmonics) {
        Json row{{"order", h.order}};
        row.update(line(h));
        row["db_re_first"] = decibels(h.power) - first;
        row["deviation_hz"] = h.frequency - h.order * r.fundamental.frequency;
        row["present"] = h.present;
        json["harmonics"].push_back(row);
    }
    for (const SpectralLine& l : r.peaks) json["peaks"].push_back(line(l));
    for (const HumLine& l : r.hum) {
        Json row = line(l);
        row["mains_hz"] = l.mains;
        row["order"] = l.order;
        json["hum"].push_back(row);
    }
    for (const Band& b : r.bands)
        json["bands"].push_back(
            {{"hz", b.centre}, {"db", decibels(b.power)}, {"deviation_db", band_deviation(b, r.lines)}});
    for (const SpectralLine& l : r.envelope) json["envelope"].push_back(line(l));
    return json;
}

}  // namespace

double band_deviation(const Band& band, const Spectrum& spectrum) {
    const double bins = std::max(1.0, (band.high - band.low) / spectrum.noise_bandwidth);
    return 10.0 / std::log(10.0) * spectrum.relative_deviation() / std::sqrt(bins);
}

double decibels(double power) { return 10.0 * std::log10(std::max(power, 1e-30)); }

AnalysedFile analyse_file(const std::filesystem::path& file, const SpectrumChoice& choice,
                          const std::function<void(double)>& progress) {
    RecordReader reader = open_record(file, choice);
    const std::vector<std::size_t> chosen = chosen_channels(reader, file, choice);
    AnalysedFile out{file, reader.rate(), 0.0, reader.calibration(), reader.log(), {}, {}};
    AnalysisSettings settings;
    settings.psd = out.psd = psd_settings(choice, reader.rate(), reader.frames());
    std::tie(settings.lowest, settings.highest) = parse_band(choice.rate, "--fundamental");
    if (!choice.envelope.empty()) settings.envelope = parse_band(choice.envelope, "--envelope");
    settings.orders = choice.orders;
    settings.spectrogram = !choice.plot.empty() || !choice.report.empty();
    std::vector<VibrationAnalysis> analyses;
    try {
        for (std::size_t i = 0; i < chosen.size(); ++i) analyses.emplace_back(settings, reader.frames());
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", file.string(), error.message()));
    }
    RecordBlock block;
    std::size_t done = 0;
    while (reader.next(block)) {
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            if (block.after_gap) analyses[i].gap();
            analyses[i].push(block.channels[chosen[i]]);
        }
        done += block.size();
        if (progress)
            progress(static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, reader.frames())));
    }
    out.duration = static_cast<double>(done) / out.rate;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        out.channels.push_back({reader.channels()[chosen[i]], analyses[i].report(), {}});
        Spectrum& psd = out.channels.back().report.psd;
        if (choice.scaling == "spectrum")
            for (double& power : psd.power) power *= psd.noise_bandwidth;
        out.channels.back().warnings = warnings_of(out.channels.back().report, out);
    }
    return out;
}

std::string analysis_json(const AnalysedFile& file, const SpectrumChoice& choice) {
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
        const Spectrum& psd = file.channels.front().report.psd;
        json["psd"] = {{"df_hz", psd.df},
                       {"units", power_unit(file, choice.scaling == "density")},
                       {"enbw_hz", psd.noise_bandwidth},
                       {"window", choice.window},
                       {"segment", file.psd.segment},
                       {"overlap", file.psd.overlap},
                       {"detrend", choice.detrend},
                       {"average", choice.average},
                       {"segments", psd.segments},
                       {"relative_deviation", psd.relative_deviation()},
                       {"lines_df_hz", file.channels.front().report.lines.df}};
    }
    return json.dump(2) + "\n";
}

std::string analysis_text(const AnalysedFile& file) {
    std::string text = fmt::format("{}: {:.3f} s at {:.6g} Hz, {} channel(s)\n", file.file.string(), file.duration,
                                   file.rate, file.channels.size());
    auto out = std::back_inserter(text);
    if (file.log)
        fmt::format_to(out,
                       "  uneven log, {} rows, steps {:.3g} to {:.3g} ms: resampled; nothing above {:.4g} Hz is there, "
                       "faithful to about {:.3g} Hz; faster vibration appears folded\n",
                       file.log->rows, 1e3 * file.log->shortest_step, 1e3 * file.log->longest_step, 0.5 * file.rate,
                       file.log->usable);
    for (const AnalysedChannel& channel : file.channels) {
        const VibrationReport& r = channel.report;
        const auto list = [&](const char* name, const std::vector<SpectralLine>& lines) {
            if (lines.empty()) return;
            fmt::format_to(out, "    {}:", name);
            for (const SpectralLine& l : lines)
                fmt::format_to(out, " {:.2f} ({:.1f} dB)", l.frequency, decibels(l.power));
            text += '\n';
        };
        fmt::format_to(out, "  channel {}: rms {:.4g} {}{}, crest {:.2f}\n", channel.name, r.level.rms(),
                       file.calibration.unit, file.calibration.known ? "" : " (uncalibrated)", r.level.crest());
        if (r.fundamental.frequency > 0.0) {
            fmt::format_to(out, "    fundamental {:.3f} Hz, confidence {:.2f}", r.fundamental.frequency,
                           r.fundamental.confidence);
            for (const CombFit& rival : r.fundamental.rivals)
                fmt::format_to(out, "{} {:.1f}", &rival == r.fundamental.rivals.data() ? "; or" : ",", rival.frequency);
            text += '\n';
        } else {
            text += "    no fundamental\n";
        }
        if (!r.harmonics.empty()) {
            text += "    orders:";
            for (const Harmonic& h : r.harmonics)
                fmt::format_to(out, " {}{}", h.order, h.present ? fmt::format(" {:.1f} dB", decibels(h.power)) : " –");
            text += '\n';
        }
        list("lines", r.peaks);
        for (const HumLine& h : r.hum)
            fmt::format_to(out, "    hum of {} Hz mains at {:.2f} Hz, {:.1f} dB, SNR {:.0f} dB\n", h.mains, h.frequency,
                           decibels(h.power), h.snr_db);
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

}  // namespace tactus
