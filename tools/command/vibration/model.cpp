// SPDX-License-Identifier: Apache-2.0
// tactus model: fits the model of a saw to its recordings.
#include "assets/file/json.hpp"
#include "tools/analysis/vibration/saw_modelling.hpp"
#include "tools/command/vibration/stretch_options.hpp"
#include "tools/exit_code.hpp"

#include <fmt/format.h>

#include <memory>

namespace tactus::command {

namespace {

using analysis::ModelDistance;
using analysis::ModelledRecording;
using file::Json;

struct ModelChoice {
    analysis::SawModelSettings settings;
    std::filesystem::path out;
    StretchChoice stretch;
    bool json = false;
};

Json distance_json(const ModelDistance& distance) {
    return {{"log_spectral_db", distance.log_spectral_db}, {"level_db", distance.level_db}};
}

Json rows_json(const analysis::SawModelling& modelling) {
    Json rows = Json::array();
    for (const ModelledRecording& row : modelling.recordings)
        rows.push_back({{"file", row.recording->file.string()},
                        {"state", row.recording->cutting ? "cutting" : "free_air"},
                        {"used_s", Json::array({row.recording->used_from(), row.recording->used_to()})},
                        {"rate_hz", row.recording->rate},
                        {"load_N", row.recording->load},
                        {"density_kg_per_m3", row.recording->density > 0.0 ? Json(row.recording->density) : Json()},
                        {"fitted", distance_json(row.fitted)},
                        {"left_out", row.left_out ? distance_json(*row.left_out) : Json()},
                        {"inner", row.inner}});
    return rows;
}

void print(const analysis::SawModelling& modelling, const ModelChoice& choice) {
    fmt::print("{}: {} conditions, a residual filter of order {}, {}{}\n", choice.out.string(),
               modelling.model.conditions.size(), vibration::SawModelSize::lines,
               modelling.texts.calibrated ? "in m/s^2" : "normalised",
               modelling.texts.synthesised ? "; fitted to computed sounds, not to recordings" : "");
    if (!choice.stretch.from.empty() || !choice.stretch.to.empty()) {
        const sound::Stretch stretch = stretch_of(choice.stretch);
        fmt::print("of each recording from {:g} s{}\n", stretch.from,
                   choice.stretch.to.empty() ? " on" : fmt::format(" to {:g} s", stretch.to));
    }
    fmt::print("log-spectral distance and level (rms), {:g} to {:g} Hz, dB:\n", choice.settings.lowest,
               choice.settings.highest);
    fmt::print("  {:<28} {:>8} {:>6} {:>9}   {:>15}   {}\n", "recording", "rate Hz", "load N", "kg/m^3", "fitted",
               "left out");
    for (const ModelledRecording& row : modelling.recordings) {
        const sound::Recording& recording = *row.recording;
        const auto pair = [](const ModelDistance& d) {
            return fmt::format("{:6.2f} {:+8.2f}", d.log_spectral_db, d.level_db);
        };
        fmt::print("  {:<28} {:>8.4g} {:>6} {:>9}   {:>15}   {}\n", recording.file.filename().string(), recording.rate,
                   recording.cutting ? fmt::format("{:g}", recording.load) : "-",
                   recording.density > 0.0 ? fmt::format("{:g}", recording.density) : "-", pair(row.fitted),
                   row.left_out ? pair(*row.left_out) + (row.inner ? "   between others" : "   at the edge")
                                : "the only one of its state");
    }
}

int model(const ModelChoice& choice) {
    analysis::SawModelSettings settings = choice.settings;
    settings.stretch = stretch_of(choice.stretch);
    const analysis::SawModelling modelling = analysis::model_saw(settings);
    sound::save_saw_model(modelling.model, modelling.texts, choice.out);
    if (choice.json) {
        const Json json{{"model", choice.out.string()},
                        {"unit", modelling.texts.calibrated ? "m/s^2" : "normalised"},
                        {"synthesised", modelling.texts.synthesised},
                        {"band_hz", {choice.settings.lowest, choice.settings.highest}},
                        {"rows", rows_json(modelling)}};
        fmt::print("{}\n", json.dump(2));
    } else {
        print(modelling, choice);
    }
    return done;
}

Action declare_model(VerbOptions& verb) {
    const auto choice = std::make_shared<ModelChoice>();
    verb.add("recordings", choice->settings.recordings,
             "recording set, TOML, with the rate and thrust of each recording")
        .required();
    verb.add("-o,--out", choice->out, "TOML file for the model").required();
    verb.band("--band", choice->settings.lowest, choice->settings.highest, "band of the distances, Hz");
    add_stretch_options(verb, choice->stretch);
    verb.flag("--json", choice->json, "as JSON");
    return [choice] { return model(*choice); };
}

}  // namespace

Verb model_verb() { return {"model", "make a model of a saw for the 'saw' node from its recordings", declare_model}; }

}  // namespace tactus::command
