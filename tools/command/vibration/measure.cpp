// SPDX-License-Identifier: Apache-2.0
// tactus measure: identifies a system in a patch or behind a sound card with a sine sweep.
#include "assets/file/json.hpp"
#include "tools/analysis/vibration/equalisation.hpp"
#include "tools/analysis/vibration/measurement.hpp"
#include "tools/command/patch_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

namespace tactus::command {

namespace {

using file::Json;

struct MeasureChoice {
    analysis::MeasureSettings settings;
    std::filesystem::path csv = "response.csv", equaliser;
    bool json = false;
};

constexpr const char* kinds[] = {"displacement", "velocity", "acceleration"};

using Made = std::optional<analysis::Equalisation>;

/// As 'equalise' makes it by default.
Made equalise(const MeasureChoice& choice) {
    if (choice.equaliser.empty()) return std::nullopt;
    analysis::EqualiseSettings settings;
    settings.response = choice.csv;
    Made made = analysis::equalise(settings);
    sound::save_equaliser(made->equaliser, made->title, choice.equaliser);
    return made;
}

std::string json_of(const analysis::Measurement& found, const MeasureChoice& choice, const Made& made) {
    const auto known = [&](const auto& value) { return found.resonance.hz > 0.0 ? Json(value) : Json(); };
    Json json{{"resonance_hz", known(found.resonance.hz)},
              {"damping_ratio", known(found.resonance.damping)},
              {"latency_s", found.response.identified.response.latency},
              {"response_csv", choice.csv.string()},
              {"thd", Json::array()},
              {"fit", {{"kind", known(kinds[found.resonance.order])}, {"error_db", known(found.resonance.error_db)}}},
              {"coherence_mean", found.coherence},
              {"band_hz", {found.lowest, found.highest}},
              {"unit", found.response.unit}};
    json["modes"] = Json::array();
    for (const vibration::Mode& mode : found.response.identified.modes)
        json["modes"].push_back({{"hz", mode.hz},
                                 {"damping_ratio", mode.damping},
                                 {"relative_deviation", mode.deviation},
                                 {"bias_bound", mode.truncation},
                                 {"peak", mode.peak},
                                 {"resolved", mode.is_resolved()},
                                 {"needed_duration_s", mode.needed_duration}});
    for (const analysis::DistortionOrder& order : found.orders)
        json["thd"].push_back({{"order", order.order},
                               {"percent", 100.0 * order.rms},
                               {"worst_percent", 100.0 * order.worst},
                               {"worst_hz", order.worst_hz}});
    if (found.card)
        json["device"] = {{"name", found.card->device},
                          {"output_latency_s", found.card->output_latency},
                          {"input_latency_s", found.card->input_latency},
                          {"underflows", found.card->underflows},
                          {"clipped_samples", found.clipped}};
    if (made)
        json["equaliser"] = {{"file", choice.equaliser.string()},
                             {"band_hz", {made->equaliser.lowest, made->equaliser.highest}},
                             {"deviation_before_db", made->flat.before_db},
                             {"deviation_after_db", made->flat.after_db}};
    return json.dump(2) + "\n";
}

void print(const analysis::Measurement& found, const MeasureChoice& choice, const Made& made) {
    const analysis::MeasureSettings& settings = choice.settings;
    fmt::print("{}\n", found.response.title);
    if (!(found.resonance.hz > 0.0))
        fmt::print("  resonance   none from {:.0f} to {:.0f} Hz\n", settings.fit_lowest, found.fit_highest);
    else
        fmt::print("  resonance   {:.1f} Hz, damping ratio {:.3f} ({} response, fit within {:.2f} dB)\n",
                   found.resonance.hz, found.resonance.damping, kinds[found.resonance.order], found.resonance.error_db);
    for (const vibration::Mode& mode : found.response.identified.modes) {
        fmt::print(
            "  mode        {:.2f} Hz, damping ratio {:.3g} ± {:.1f} % (Q {:.0f}), bias at most {:.1f} %, peak {:.2f} "
            "dB\n",
            mode.hz, mode.damping, 100.0 * mode.deviation, 0.5 / mode.damping, 100.0 * mode.truncation,
            20.0 * std::log10(mode.peak));
        if (!mode.is_resolved())
            fmt::print("              its damping needs {:.0f} s for 5 %: --duration {:.0f}\n", mode.needed_duration,
                       std::ceil(mode.needed_duration));
    }
    fmt::print("  latency     {:.3f} ms\n", 1e3 * found.response.identified.response.latency);
    fmt::print("  coherence   {:.4f} on average from {:.0f} to {:.0f} Hz\n", found.coherence, found.lowest,
               found.highest);
    for (const analysis::DistortionOrder& order : found.orders)
        fmt::print("  order {}     {:.3f} % (rms), worst {:.3f} % at {:.0f} Hz\n", order.order, 100.0 * order.rms,
                   100.0 * order.worst, order.worst_hz);
    if (found.card)
        fmt::print("  sound card  reports {:.3f} ms out and {:.3f} ms in; lost sound {} times\n",
                   1e3 * found.card->output_latency, 1e3 * found.card->input_latency, found.card->underflows);
    if (found.clipped > 0)
        fmt::print("  CLIPPED     the input was at full scale {} times: give a smaller --amplitude\n", found.clipped);
    fmt::print("  response    {}\n", choice.csv.string());
    if (made)
        fmt::print("  equaliser   {}: from {:g} to {:g} Hz {:.1f} dB off flat without it, {:.1f} dB with it\n",
                   choice.equaliser.string(), made->equaliser.lowest, made->equaliser.highest, made->flat.before_db,
                   made->flat.after_db);
}

int measure(const MeasureChoice& choice) {
    LiveLine line;
    const analysis::Measurement found = analysis::measure(
        choice.settings, [&](double share) { line.show(fmt::format("{:3.0f} % of the sweep", 100.0 * share)); });
    line.clear();
    sound::save_response(found.response, choice.csv);
    const Made made = equalise(choice);
    if (choice.json) fmt::print("{}", json_of(found, choice, made));
    else print(found, choice, made);
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
    verb.add("-o,--out", choice->csv, "CSV file for the response").shows_default();
    verb.add("--equaliser", choice->equaliser,
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
    verb.flag("--json", choice->json, "as JSON");
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
    return {"measure", "sweep a patch or a sound card: frequency response, resonance, distortion, latency",
            declare_measure};
}

}  // namespace tactus::command
