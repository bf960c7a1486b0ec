// SPDX-License-Identifier: Apache-2.0
// tactus validate: compares the handle's vibration in a patch with each recording that its saw plays.
#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/readable.hpp"
#include "tools/command/batch.hpp"
#include "tools/command/figure_options.hpp"
#include "tools/command/patch_options.hpp"
#include "tools/command/vibration/comparison_text.hpp"
#include "tools/command/vibration/stretch_options.hpp"
#include "tools/command/vibration/validation_text.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/figures/comparison_figure.hpp"
#include "tools/report/figures/validation_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace tactus::command {

namespace {

using analysis::Validation;
using analysis::ValidationRun;
using file::Json;

struct ValidateChoice {
    analysis::ValidateSettings settings;
    std::filesystem::path thresholds, report, plot, table;
    std::string touch = "displacement";
    StretchChoice stretch;
    int jobs = 0;  // runs at a time, 0: one per core
    bool json = false;
};

Json run_json(const ValidationRun& run) {
    Json json{{"file", run.recording->file.string()},
              {"state", run.recording->cutting ? "cutting" : "free_air"},
              {"rate_hz", run.recording->rate},
              {"load_N", run.recording->load},
              {"level_db", run.level_db},
              {"drive_rms_v", run.drive_rms ? Json(*run.drive_rms) : Json()},
              {"drive_peak_v", run.drive_peak ? Json(*run.drive_peak) : Json()}};
    if (!run.failure.empty()) json["error"] = run.failure;
    else json.update(Json::parse(comparison_json(run.pair)));
    return json;
}

std::string json_text(const Validation& validation, const analysis::ValidateSettings& settings,
                      const VerdictCounts& count) {
    Json json{{"patch", validation.patch},
              {"set", validation.set->path.string()},
              {"synthesised", validation.set->synthesised},
              {"calibrated", validation.set->calibrated()},
              {"out", validation.path.out},
              {"stretch_of_run", {{"from_s", settings.from}, {"to_s", settings.from + settings.seconds}}},
              {"verdict", count.failed + count.bad == 0 ? "pass" : "fail"},
              {"passed", count.passed},
              {"failed", count.failed},
              {"bad", count.bad},
              {"runs", Json::array()}};
    for (const ValidationRun& run : validation.runs) json["runs"].push_back(run_json(run));
    return json.dump(2) + "\n";
}

void print(const Validation& validation, const analysis::ValidateSettings& settings, const VerdictCounts& count) {
    fmt::print("{} at {}, beside {}{}\n", validation.patch, validation.path.out, validation.set->path.string(),
               validation.set->synthesised ? " (synthesised, no recordings)" : "");
    fmt::print("compared: {} to {} s of each run, with the stretch of the recording that was played then\n",
               plain(settings.from, 6), plain(settings.from + settings.seconds, 6));
    fmt::print("{}", validation_rows(validation));
    fmt::print("{}: {} of {} have the vibration of their recording\n", count.failed + count.bad == 0 ? "PASS" : "FAIL",
               count.passed, validation.runs.size());
}

/// --from and --to are of each run; the recording is compared in the stretch that was played then.
void choose_stretch(const StretchChoice& choice, analysis::ValidateSettings& settings) {
    if (!choice.from.empty()) settings.from = choice.from.front();
    if (!choice.to.empty()) settings.seconds = choice.to.front() - settings.from;
    if (!(settings.seconds >= 0.5 && settings.seconds <= 600.0 && settings.from <= 3600.0))
        throw Error(
            fmt::format("the compared stretch of a run must take 0.5 s to 600 s, within the first hour; {} s to "
                        "{} s does not",
                        plain(settings.from, 6), plain(settings.from + settings.seconds, 6)));
}

int validate(const ValidateChoice& choice) {
    analysis::ValidateSettings settings = choice.settings;
    if (!choice.thresholds.empty()) settings.thresholds = table::load_thresholds(choice.thresholds);
    settings.touch = touch_of(choice.touch);
    choose_stretch(choice.stretch, settings);
    Validation validation = analysis::plan_validation(settings);
    const bool pictures = !choice.report.empty() || !choice.plot.empty();
    if (!choice.plot.empty()) std::filesystem::create_directories(choice.plot);
    const std::vector<std::string> failures = run_batch(
        validation.runs.size(), choice.jobs, "runs",
        [&](std::size_t i,
            const std::function<void(double)>&) {  // Spectrograms are large, so they are computed for one level only.
            analysis::validate(validation, i, settings,
                               pictures && validation.runs[i].level_db == settings.levels.front());
        });
    VerdictCounts count;
    count.bad = tell_failures(failures);
    for (std::size_t i = 0; i < failures.size(); ++i) {
        ValidationRun& run = validation.runs[i];
        run.failure = failures[i];
        if (!run.failure.empty()) continue;
        ++(run.pair.verdict.passed() ? count.passed : count.failed);
        if (!choice.plot.empty())
            save_figure(report::draw_comparison(run.pair), choice.plot / (run.file_name() + ".svg"), {});
    }
    if (!choice.table.empty()) file::write_whole_file(choice.table, validation_csv(validation));
    if (!choice.report.empty()) file::write_whole_file(choice.report, report::validation_page(validation));
    if (choice.json) fmt::print("{}", json_text(validation, settings, count));
    else print(validation, settings, count);
    return count.bad > 0 ? bad_input : count.failed > 0 ? answer_is_no : done;
}

Action declare_validate(VerbOptions& verb) {
    const auto choice = std::make_shared<ValidateChoice>();
    analysis::ValidateSettings& settings = choice->settings;
    add_patch_options(verb, settings.patch);
    verb.add("--reference", settings.set, "recording set, TOML, or one sound; the patch's saw plays it").required();
    verb.add("--level", settings.levels, "gains in dB relative to the patch, one or more")
        .shows_default()
        .separated_by(',')
        .one_each()
        .range(-80.0, 40.0);
    verb.add("--saw", settings.saw, "the saw node (default: the only node of type saw)");
    verb.add("--probe", settings.out_port,
             "NODE.PORT, the handle's vibration (default: the port recorded as handle.wav, or the actuator's)");
    const Option seconds = verb.add("--seconds", settings.seconds, "compared time of each run, s")
                               .unit("s")
                               .shows_default()
                               .range(0.5, 600.0);
    add_stretch_options(verb, choice->stretch);
    verb.find("--from").about(
        "where the compared stretch of each run begins (default 1 s: after the run-up); the recording is compared in "
        "the "
        "stretch that is played then");
    verb.find("--to").about("where it ends, instead of --seconds").excludes(seconds);
    verb.add("--thresholds", choice->thresholds, "TOML file with the thresholds, as for compare");
    verb.add("--touch", choice->touch, "quantity of the threshold of touch")
        .shows_default()
        .one_of({"displacement", "acceleration", "none"});
    verb.add("--report", choice->report, "HTML file with figures, tables and methods");
    verb.add("--plot", choice->plot, "folder for SVG figures of the runs");
    verb.add("--table", choice->table, "CSV file with one row per run");
    verb.add("--jobs", choice->jobs, "runs at a time, 0: one per core").range(0, 256);
    verb.flag("--json", choice->json, "as JSON");
    verb.old("--out", "--probe");
    return [choice] { return validate(*choice); };
}

}  // namespace

Verb validate_verb() {
    return {"validate",
            "judge whether the handle vibrates like the saw at every recorded rate and load; exit code 0: yes, 1: no",
            declare_validate};
}

}  // namespace tactus::command
