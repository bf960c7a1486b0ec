// SPDX-License-Identifier: Apache-2.0
// tactus response: frequency response and coherence between two channels of a record.
#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/sound/response_file.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/vibration/two_channels.hpp"
#include "tools/command/figure_options.hpp"
#include "tools/command/vibration/record_json.hpp"
#include "tools/command/vibration/record_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/figures/response_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>

namespace tactus::command {

namespace {

using file::Json;

struct ResponseChoice : RecordChoice {
    std::string estimator = "h1";
    std::optional<std::size_t> segment;
    std::optional<double> overlap;
    std::filesystem::path csv, plot, out;
    FigureChoice figure;
};

constexpr const char* estimators[] = {"H1", "H2", "Hv"};

std::string json_of(const std::string& file, const analysis::TwoChannels& found) {
    Json json{{"file", file},
              {"input", found.input},
              {"output", found.output},
              {"sample_rate_hz", found.rate},
              {"duration_s", found.duration},
              {"usable_hz", found.usable},
              {"stretch", stretch_json(found.stretch)},
              {"calibration", calibration_json(found.calibration)},
              {"log", found.log ? log_json(*found.log, found.rate) : Json()},
              {"estimator", estimators[static_cast<int>(found.estimator)]},
              {"segment", found.welch.segment},
              {"segments", found.spectra.segments},
              {"effective_segments", found.spectra.effective_segments},
              {"df_hz", found.spectra.df},
              {"coherence_of_noise", found.noise_coherence},
              {"delay_s", found.delay},
              {"peaks", Json::array()}};
    for (const analysis::ResponsePeak& peak : found.peaks)
        json["peaks"].push_back({{"hz", peak.hz},
                                 {"level_db", peak.level_db},
                                 {"phase_deg", peak.phase * 180.0 / pi},
                                 {"coherence", peak.coherence},
                                 {"deviation_db", peak.deviation_db}});
    return json.dump(2) + "\n";
}

std::string text_of(const std::string& file, const analysis::TwoChannels& found) {
    std::string text = fmt::format("{}: from {} to {}, {}\n", file, found.input, found.output,
                                   estimators[static_cast<int>(found.estimator)]);
    if (!found.stretch.is_whole()) text += fmt::format("  of the record: {}\n", found.stretch.text());
    for (const std::string& line : analysis::understood(found.calibration, found.log, found.rate))
        text += "  " + line + "\n";
    double coherent = 0.0, bins = 0.0;
    for (std::size_t k = 1; k < found.coherence.size() && found.spectra.frequency(k) <= found.usable; ++k) {
        coherent += found.coherence[k] >= 0.9;
        bins += 1.0;
    }
    fmt::format_to(std::back_inserter(text),
                   "  {} segments, bins {:.4g} Hz apart; coherence of unrelated noise {:.3f}; {:.0f} % of the bins "
                   "have at least 0.9\n",
                   found.spectra.segments, found.spectra.df, found.noise_coherence,
                   100.0 * coherent / std::max(1.0, bins));
    if (coherent > 0.0) fmt::format_to(std::back_inserter(text), "  delay {:.3f} ms\n", 1e3 * found.delay);
    for (const analysis::ResponsePeak& peak : found.peaks)
        fmt::format_to(std::back_inserter(text), "  peak at {:.2f} Hz: {:.2f} dB ± {:.2f}, {:.0f}°, coherence {:.3f}\n",
                       peak.hz, peak.level_db, peak.deviation_db, peak.phase * 180.0 / pi, peak.coherence);
    if (found.peaks.empty()) text += "  no peak with a coherence of at least 0.8\n";
    return text;
}

std::string csv_of(const analysis::TwoChannels& found) {
    std::string csv = "frequency_hz,h1_db,h1_deg,h2_db,h2_deg,hv_db,hv_deg,coherence,h1_deviation\n";
    for (std::size_t k = 1; k < found.coherence.size(); ++k) {
        csv += fmt::format("{}", found.spectra.frequency(k));
        for (const auto* h : {&found.h1, &found.h2, &found.hv})
            csv += std::abs((*h)[k]) > 0.0 ? fmt::format(",{:.9g},{:.9g}", 20.0 * std::log10(std::abs((*h)[k])),
                                                         std::arg((*h)[k]) * 180.0 / pi)
                                           : std::string(",,");
        csv += fmt::format(",{:.9g},{:.6g}\n", found.coherence[k], found.deviation[k]);
    }
    return csv;
}

/// For 'equalise': without the delay.
void save(const analysis::TwoChannels& found, const std::string& file, const std::filesystem::path& out) {
    sound::ResponseFile response{fmt::format("{}: {} to {}", file, found.input, found.output), "", {}};
    vibration::FrequencyResponse& curve = response.identified.response;
    curve.latency = std::max(0.0, found.delay);
    for (std::size_t k = 1; k < found.coherence.size() && found.spectra.frequency(k) <= found.usable; ++k) {
        const double hz = found.spectra.frequency(k);
        if (!(std::abs(found.chosen()[k]) > 0.0)) continue;
        curve.hz.push_back(hz);
        curve.gain.push_back(found.chosen()[k] * std::polar(1.0, 2.0 * pi * hz * curve.latency));
        curve.coherence.push_back(found.coherence[k]);
    }
    if (curve.hz.size() < 3) throw Error(file + ": there is no response to save, a channel is silent");
    sound::save_response(response, out);
}

int response(const ResponseChoice& choice) {
    if (choice.files.size() != 1) throw Error("response takes one file");
    const std::filesystem::path& file = choice.files.front();
    analysis::ResponseSettings settings;
    settings.record = choice.settings();
    if (settings.record.channels.empty() && settings.record.log.columns.empty()) settings.record.channels = {1, 2};
    settings.estimator = choice.estimator == "h2"   ? analysis::Estimator::h2
                         : choice.estimator == "hv" ? analysis::Estimator::hv
                                                    : analysis::Estimator::h1;
    settings.segment = choice.segment;
    settings.overlap = choice.overlap.value_or(0.5);
    const analysis::TwoChannels found = analysis::analyse_two_channels(file, settings, {});
    if (!choice.csv.empty()) file::write_whole_file(choice.csv, csv_of(found));
    if (!choice.out.empty()) save(found, file.filename().string(), choice.out);
    if (!choice.plot.empty()) save_figure(report::draw_response(found, file), choice.plot, choice.figure);
    fmt::print("{}", choice.json ? json_of(file.string(), found) : text_of(file.string(), found));
    return done;
}

Action declare_response(VerbOptions& verb) {
    const auto choice = std::make_shared<ResponseChoice>();
    add_record_options(verb, *choice, "a sound file or CSV log with input and output as channels (default 1,2)");
    verb.add("--estimator", choice->estimator, "h1: noise in the output, h2: noise in the input, hv: noise in both")
        .shows_default()
        .one_of({"h1", "h2", "hv"});
    verb.add("--segment", choice->segment, "samples (default: about 0.75 s)").range(2, 1 << 26);
    verb.add("--overlap", choice->overlap, "overlap as a fraction of a segment (default 0.5)").range(0.0, 0.99);
    verb.add("--csv", choice->csv, "CSV file with H1, H2, Hv and coherence over frequency");
    verb.add("-o,--out", choice->out, "CSV file of the response, as 'measure' writes it, for 'equalise'");
    verb.add("--plot", choice->plot, "figure, .svg, .png or .pdf: level, phase and coherence");
    add_figure_options(verb, choice->figure);
    return [choice] { return response(*choice); };
}

}  // namespace

Verb response_verb() {
    return {"response", "frequency response (H1, H2, Hv) and coherence between two channels of a record",
            declare_response};
}

}  // namespace tactus::command
