// SPDX-License-Identifier: Apache-2.0
// tactus model: fits the model of a saw to its recordings.
#include "assets/file/json.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/vibration/saw_modelling.hpp"
#include "tools/command/result_options.hpp"
#include "tools/command/vibration/stretch_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/report/vibration/saw_model_result.hpp"

#include <filesystem>
#include <memory>
#include <vector>

namespace tactus::command {

namespace {

struct ModelChoice {
    analysis::SawModelSettings settings;
    StretchChoice stretch;
    ResultChoice result;
};

int model(const ModelChoice& choice) {
    check_result_files(choice.result, {choice.settings.recordings});
    const std::vector<std::filesystem::path> files = choice.result.products();
    if (files.empty()) throw Error("name a .toml file for the model with -o");
    analysis::SawModelSettings settings = choice.settings;
    settings.stretch = stretch_of(choice.stretch);
    const analysis::SawModelling modelling = analysis::model_saw(settings);
    for (const std::filesystem::path& file : files) sound::save_saw_model(modelling.model, modelling.texts, file);
    const report::MadeSawModel shown{files.front(), &modelling, &settings};
    write_result(report::saw_model_fields().of(shown), choice.result);
    return done;
}

Action declare_model(VerbOptions& verb) {
    const auto choice = std::make_shared<ModelChoice>();
    verb.add("recordings", choice->settings.recordings,
             "recording set, TOML, with the rate and thrust of each recording")
        .required();
    add_result_options(verb, choice->result, ResultFigure::none, {{".toml"}, "the model"}).required();
    verb.band("--band", choice->settings.lowest, choice->settings.highest, "band of the distances, Hz");
    add_stretch_options(verb, choice->stretch);
    return [choice] { return model(*choice); };
}

}  // namespace

Verb model_verb() {
    return {.name = "model",
            .about = "make a model of a saw for the 'saw' node from its recordings",
            .add = declare_model,
            .schema = [] { return report::schema_of_output({report::saw_model_fields().schema()}); }};
}

}  // namespace tactus::command
