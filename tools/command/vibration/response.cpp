// SPDX-License-Identifier: Apache-2.0
// tactus response: frequency response and coherence between two channels of a record.
#include "assets/file/json.hpp"
#include "assets/sound/response_file.hpp"
#include "assets/table/csv_file.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/vibration/two_channels.hpp"
#include "tools/command/result_options.hpp"
#include "tools/command/vibration/record_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/report/vibration/response_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace tactus::command {

namespace {

struct ResponseChoice : RecordChoice {
    std::string estimator = "h1";
    std::optional<std::size_t> segment;
    std::optional<double> overlap;
    std::filesystem::path csv;
    ResultChoice result;
};

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
    check_result_files(choice.result, choice.files, {choice.csv});
    const analysis::TwoChannels found = analysis::analyse_two_channels(file, settings, {});
    for (const std::filesystem::path& out : choice.result.products()) save(found, file.filename().string(), out);
    if (!choice.csv.empty()) table::save_csv(choice.csv, csv_of(found));
    write_result(report::response_fields().of({file, &found}), choice.result);
    return done;
}

Action declare_response(VerbOptions& verb) {
    const auto choice = std::make_shared<ResponseChoice>();
    add_record_options(verb, *choice, "a sound file or CSV log with input and output as channels (default 1,2)");
    verb.add("--estimator", choice->estimator, "h1: noise in the output, h2: noise in the input, hv: noise in both")
        .shows_default()
        .one_of({"h1", "h2", "hv"});
    verb.add("--segment", choice->segment, "samples (default: about 0.75 s); a peak needs 10 bins")
        .range(2, 1 << 26);
    verb.add("--overlap", choice->overlap, "overlap as a fraction of a segment (default 0.5)").range(0.0, 0.99);
    verb.output("--csv", choice->csv, {{".csv"}}, "CSV file with H1, H2, Hv and coherence over frequency");
    add_result_options(verb, choice->result, ResultFigure::styled,
                       {{".csv"}, "the response as 'measure' writes it, for 'equalise'"});
    verb.old("--plot", "--out");
    return [choice] { return response(*choice); };
}

}  // namespace

Verb response_verb() {
    return {.name = "response",
            .about = "frequency response (H1, H2, Hv) and coherence between two channels of a record",
            .add = declare_response,
            .schema = [] { return report::schema_of_output({report::response_fields().schema()}); }};
}

}  // namespace tactus::command
