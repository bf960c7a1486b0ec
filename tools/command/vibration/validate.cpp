// SPDX-License-Identifier: Apache-2.0
// tactus validate: compares the handle's vibration in a patch with each recording that its saw plays.
#include "assets/file/json.hpp"
#include "assets/table/csv_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/readable.hpp"
#include "tools/command/batch.hpp"
#include "tools/command/patch_options.hpp"
#include "tools/command/result_options.hpp"
#include "tools/command/vibration/stretch_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/figures/comparison_figure.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/report/vibration/comparison_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::command {

namespace {

using analysis::Validation;
using analysis::ValidationRun;

struct ValidateChoice {
    analysis::ValidateSettings settings;
    std::filesystem::path thresholds, plot, table;
    std::string touch = "displacement";
    StretchChoice stretch;
    int jobs = 0;  // runs at a time, 0: one per core
    ResultChoice result;
};

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
    // Before the check of -o, which may be in it.
    if (!choice.plot.empty()) std::filesystem::create_directories(choice.plot);
    check_result_files(choice.result, {choice.settings.set, choice.thresholds});
    analysis::ValidateSettings settings = choice.settings;
    if (!choice.thresholds.empty()) settings.thresholds = table::load_thresholds(choice.thresholds);
    settings.touch = analysis::touch_of(choice.touch);
    choose_stretch(choice.stretch, settings);
    Validation validation = analysis::plan_validation(settings);
    const bool pictures = choice.result.shows_figures() || !choice.plot.empty();
    const std::vector<std::string> failures = run_batch(
        validation.runs.size(), choice.jobs, "runs",
        [&](std::size_t i,
            const std::function<void(double)>&) {  // Spectrograms are large, so they are computed for one level only.
            analysis::validate(validation, i, settings,
                               pictures && validation.runs[i].level_db == settings.levels.front());
        },
        choice.result.quiet);
    tell_failures(failures);
    for (std::size_t i = 0; i < failures.size(); ++i) {
        ValidationRun& run = validation.runs[i];
        run.failure = failures[i];
        if (run.failure.empty() && !choice.plot.empty())
            save_figure(report::draw_comparison(run.pair), choice.plot / (run.file_name() + ".svg"), {});
    }
    if (!choice.table.empty()) table::save_csv(choice.table, report::validation_table(validation));
    const report::ValidatedRuns found{&validation, &settings};
    write_result(report::validation_fields().of(found), choice.result);
    const report::VerdictCounts counts = found.counts();
    return counts.bad > 0 ? bad_input : counts.failed > 0 ? answer_is_no : done;
}

/// Old spelling: `--out` was the port. It applies to a value that is no file for a result.
void port_was_out(std::vector<std::string>& words) {
    constexpr std::string_view joined = "--out=";
    for (std::size_t n = 0; n < words.size(); ++n) {
        std::string& word = words[n];
        const bool is_joined = word.starts_with(joined);
        if (!is_joined && (word != "--out" || n + 1 == words.size())) continue;
        const std::string value = is_joined ? word.substr(joined.size()) : words[n + 1];
        if (!is_result_file(value)) word.replace(0, 5, "--probe");
    }
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
    add_result_options(verb, choice->result, ResultFigure::some);
    verb.old("--report", "--out");
    verb.output("--plot", choice->plot, OutputFormat::folder(), "folder for SVG figures of the runs");
    verb.output("--table", choice->table, {{".csv"}}, "CSV file with one row per run");
    verb.add("--jobs", choice->jobs, "runs at a time, 0: one per core").range(0, 256);
    verb.old(port_was_out);
    return [choice] { return validate(*choice); };
}

}  // namespace

Verb validate_verb() {
    return {.name = "validate",
            .about =
                "judge whether the handle vibrates like the saw at every recorded rate and load; exit code 0: yes, 1: "
                "no",
            .add = declare_validate,
            .schema = [] { return report::schema_of_output({report::validation_fields().schema()}); }};
}

}  // namespace tactus::command
