// SPDX-License-Identifier: Apache-2.0
// tactus measure: identifies a system in a patch or behind a sound card with a sine sweep.
#include "assets/file/json.hpp"
#include "tools/analysis/vibration/equalisation.hpp"
#include "tools/analysis/vibration/measurement.hpp"
#include "tools/command/patch_options.hpp"
#include "tools/command/progress.hpp"
#include "tools/command/result_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/report/vibration/equaliser_result.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace tactus::command {

namespace {

struct MeasureChoice {
    analysis::MeasureSettings settings;
    std::filesystem::path equaliser;
    ResultChoice result;
};

int measure(const MeasureChoice& choice) {
    check_result_files(choice.result, {choice.settings.patch.patch}, {choice.equaliser});
    Progress progress(choice.result.quiet);
    const analysis::Measurement found =
        analysis::measure(choice.settings, [&](double share) { progress.show(share, "of the sweep"); });
    progress.clear();
    std::vector<std::filesystem::path> files = choice.result.products();
    if (files.empty()) files.emplace_back("response.csv");
    for (const std::filesystem::path& file : files) sound::save_response(found.response, file);
    report::MeasuredResponse shown{&found, files.front(), choice.settings.fit_lowest, {}};
    analysis::Equalisation made;
    if (!choice.equaliser.empty()) {
        // As 'equalise' makes it by default.
        analysis::EqualiseSettings settings;
        settings.response = files.front();
        made = analysis::equalise(settings);
        sound::save_equaliser(made.equaliser, made.title, choice.equaliser);
        shown.equaliser = report::MadeEqualiser{choice.equaliser, &made, "minimum"};
    }
    write_result(report::measurement_fields().of(shown), choice.result);
    return done;
}

/// Old spelling: `--out` was the port and `--csv` the file. It applies when --in is given without --probe.
void port_was_out(std::vector<std::string>& words) {
    const auto is = [](const char* option) {
        return
            [option](const std::string& word) { return word == option || word.starts_with(std::string(option) + "="); };
    };
    const bool is_old = std::ranges::any_of(words, is("--in")) && std::ranges::none_of(words, is("--probe"));
    for (std::string& word : words)
        if (is_old && is("--out")(word)) word.replace(0, 5, "--probe");
        else if (is("--csv")(word)) word.replace(0, 5, "--out");
}

Action declare_measure(VerbOptions& verb) {
    const auto choice = std::make_shared<MeasureChoice>();
    analysis::MeasureSettings& settings = choice->settings;
    verb.add("patch", settings.patch.patch, "patch file, or a name in the library");
    verb.add("--in", settings.in, "NODE.PORT that the sweep feeds (an input) or replaces (an output)");
    verb.add("--probe", settings.out_port, "NODE.PORT, the output that is recorded");
    verb.add("--actuator", settings.actuator,
             "instead of ports: an entry of [actuators] that plays the sweep on its channel of the sound card");
    verb.add("--sensor", settings.sensor, "an entry of [sensors] that hears it, in its own unit");
    verb.add("--device", settings.device, "a sound card instead: part of its name, or 'default'");
    verb.add("--output-channel", settings.output_channel, "output channel of the card, from 1").shows_default();
    verb.add("--input-channel", settings.input_channel, "input channel of the card, from 1").shows_default();
    verb.add("--rate", settings.rate, "sample rate of the card, Hz").unit("Hz").shows_default().range(1e3, 1e6);
    add_result_options(verb, choice->result, ResultFigure::none, {{".csv"}, "the response (default response.csv)"});
    verb.output("--equaliser", choice->equaliser, {{".toml"}},
                "also make the filter for the 'equaliser' node, as 'equalise' does: TOML file");
    verb.band("--band", settings.first, settings.last, "first and last frequency of the sweep, Hz");
    verb.add("--duration", settings.duration, "duration of the sweep, s").unit("s").shows_default().range(0.1, 1e3);
    verb.add("--pause", settings.pause, "silence after the sweep, s").unit("s").shows_default().range(0.05, 1e2);
    verb.add("--repeats", settings.repeats, "number of sweeps, averaged").shows_default().range(1, 1000);
    verb.add("--amplitude", settings.amplitude,
             "amplitude of the sweep, in the unit of the port or actuator that it feeds; card alone: of full scale")
        .shows_default();
    verb.band("--fit-band", settings.fit_lowest, settings.fit_highest, "search range of the resonance, Hz");
    add_override_options(verb, settings.patch);
    verb.add("--first", settings.first, "first frequency, Hz").range(0.1, 1e5).hidden();
    verb.add("--last", settings.last, "last frequency, Hz").range(0.1, 1e5).hidden();
    verb.add("--fit-from", settings.fit_lowest, "search range of the resonance, Hz").hidden();
    verb.add("--fit-to", settings.fit_highest, "upper limit of the search range, Hz").hidden();
    verb.old(port_was_out);
    verb.check([&settings] {
        if (settings.first < 0.1 || settings.last > 1e5) throw Error("--band takes frequencies from 0.1 Hz to 100 kHz");
    });
    return [choice] { return measure(*choice); };
}

}  // namespace

Verb measure_verb() {
    return {.name = "measure",
            .about = "sweep a patch or a sound card: frequency response, resonance, distortion, latency",
            .add = declare_measure,
            .schema = [] { return report::schema_of_output({report::measurement_fields().schema()}); }};
}

}  // namespace tactus::command
