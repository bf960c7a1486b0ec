// SPDX-License-Identifier: Apache-2.0
// tactus equalise: designs an inverse filter from a measured response and checks the actuator's limits.
#include "assets/file/json.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/vibration/equalisation.hpp"
#include "tools/command/result_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/report/vibration/equaliser_result.hpp"

#include <cmath>
#include <filesystem>
#include <memory>
#include <vector>

namespace tactus::command {

namespace {

struct EqualiseChoice {
    analysis::EqualiseSettings settings;
    std::string kind = "minimum";
    double greatest_boost_db = 20.0;
    ResultChoice result;
};

int equalise(const EqualiseChoice& choice) {
    check_result_files(choice.result, {choice.settings.response, choice.settings.signal});
    const std::vector<std::filesystem::path> files = choice.result.products();
    if (files.empty()) throw Error("name a .toml file for the filter with -o");
    analysis::EqualiseSettings settings = choice.settings;
    settings.design.kind =
        choice.kind == "linear" ? vibration::EqualiserKind::linear_phase : vibration::EqualiserKind::minimum_phase;
    settings.design.greatest_gain = std::pow(10.0, choice.greatest_boost_db / 20.0);
    const analysis::Equalisation made = analysis::equalise(settings);
    for (const std::filesystem::path& file : files)
        sound::save_equaliser(made.equaliser, made.title.empty() ? settings.response.stem().string() : made.title,
                              file);
    write_result(report::equaliser_fields().of({files.front(), &made, choice.kind}), choice.result);
    return done;
}

Action declare_equalise(VerbOptions& verb) {
    const auto choice = std::make_shared<EqualiseChoice>();
    analysis::EqualiseSettings& settings = choice->settings;
    vibration::EqualiserDesign& design = settings.design;
    verb.add("response", settings.response, "file of 'tactus measure', or a table of Hz, dB and degrees").required();
    add_result_options(verb, choice->result, ResultFigure::none, {{".toml"}, "the filter"}).required();
    verb.add("--kind", choice->kind,
             "minimum: minimum phase, adds at most 2 ms; linear: also corrects the phase, adds half its length")
        .shows_default()
        .one_of({"minimum", "linear"});
    verb.add("--rate", design.rate, "sample rate of the node that will use the filter, Hz").unit("Hz").shows_default();
    verb.band("--band", design.lowest, design.highest, "band to be made flat, Hz");
    verb.add("--from", design.lowest, "lower limit of the band, Hz").hidden();
    verb.add("--to", design.highest, "upper limit of the band, Hz").hidden();
    verb.add("--length", design.length, "length of the impulse response, s").unit("s").shows_default();
    verb.add("--max-boost", choice->greatest_boost_db, "greatest gain of the filter, dB")
        .shows_default()
        .range(0.0, 60.0);
    verb.add("--regularisation", design.regularisation,
             "fraction of the mean power gain below which the filter does not boost")
        .shows_default()
        .range(0.0, 1.0);
    verb.add("--actuator", settings.actuator, "actuator with the voltage and current limits").shows_default();
    verb.add("--volts", settings.volts, "drive voltage per unit of the response's input").shows_default();
    verb.add("--signal", settings.signal, "a recording to check against the limits");
    verb.add("--scale", settings.scale, "units of the response's input per full scale of the recording")
        .shows_default();
    return [choice] { return equalise(*choice); };
}

}  // namespace

Verb equalise_verb() {
    return {.name = "equalise",
            .about = "make a filter for the 'equaliser' node from a measured response",
            .add = declare_equalise,
            .schema = [] { return report::schema_of_output({report::equaliser_fields().schema()}); }};
}

}  // namespace tactus::command
