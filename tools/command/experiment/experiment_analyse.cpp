// SPDX-License-Identifier: Apache-2.0
// tactus experiment analyse: tables, tests and a report.
#include "dsp/core/error.hpp"
#include "tools/analysis/experiment/analysis.hpp"
#include "tools/analysis/experiment/experiment_folder.hpp"
#include "tools/analysis/experiment/mixed_models.hpp"
#include "tools/command/options.hpp"
#include "tools/command/result_options.hpp"
#include "tools/counted.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/experiment/experiment_result.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/run/stop_signals.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>

namespace tactus::command {

namespace fs = std::filesystem;

namespace {

struct AnalyseChoice {
    std::filesystem::path folder;
    analysis::AnalysisSettings settings;
    bool checks_takes = false, has_mixed_models = false;
    ResultChoice printed;
};

/// Within the folder only names of results: every other name may be that of data, and `withdraw` deletes results.
void check_results_in_folder(const AnalyseChoice& choice) {
    std::error_code failed;
    const fs::path folder = fs::weakly_canonical(fs::absolute(choice.folder), failed);
    for (const fs::path& out : choice.printed.out) {
        const fs::path file = fs::weakly_canonical(fs::absolute(out), failed);
        if (std::ranges::mismatch(folder, file).in1 != folder.end()) continue;
        if (file.parent_path() != folder || !analysis::is_experiment_result(file.filename().string()))
            throw Error(fmt::format("{}: results in the folder of an experiment are named {}, as {}", out.string(),
                                    fmt::join(analysis::result_stems, " or "),
                                    (choice.folder / ("report" + out.extension().string())).string()));
    }
}

int analyse(const AnalyseChoice& choice) {
    check_result_files(choice.printed, {});
    check_results_in_folder(choice);
    const analysis::ExperimentAnalysis analysis = analysis::analyse_experiment(choice.folder, choice.settings);
    analysis::write_bids(analysis, choice.folder);
    report::FoundExperiment found{&analysis, {}};
    if (choice.has_mixed_models)
        found.mixed =
            analysis::fit_mixed_models(analysis, choice.folder, choice.settings.has_carry_over, run::stop_on_signals());
    const report::Result result = report::experiment_fields().of(found);
    ResultChoice kept;
    kept.out = {choice.folder / "results.json", choice.folder / "report.html"};
    write_files(result, kept);
    write_result(result, choice.printed);
    const bool says_more = !choice.printed.json && !choice.printed.quiet;
    if (!choice.checks_takes) {
        if (says_more) say(stdout, fmt::format("report: {}\n", (choice.folder / "report.html").string()));
        return done;
    }
    const analysis::TakeCheck check = analysis::check_takes(choice.folder);
    for (const std::string& difference : check.differences) say(stderr, fmt::format("tactus: {}\n", difference));
    if (says_more)
        say(stdout, fmt::format("takes: {} of {} computed again, {}\n", counted(check.values, "value"),
                                counted(check.trials, "trial"),
                                check.differences.empty() ? std::string("all equal to the bit")
                                                          : fmt::format("{} differ", check.differences.size())));
    return check.differences.empty() ? done : answer_is_no;
}

Action declare_experiment_analyse(VerbOptions& verb) {
    const auto choice = std::make_shared<AnalyseChoice>();
    verb.add("folder", choice->folder, "folder of the experiment's data").required();
    verb.add("--bootstrap", choice->settings.bootstrap, "samples for the intervals of thresholds by constant stimuli; 0: none")
        .range(0, 100'000)
        .shows_default();
    verb.flag("--carry-over", choice->settings.has_carry_over,
              "also adjust each comparison for what the condition before left behind; the interval becomes wider");
    verb.flag("--mixed-models", choice->has_mixed_models,
              "also write data and script of mixed models for R, and run them if R with lmerTest is installed");
    verb.flag("--takes", choice->checks_takes, "compute all measures again from the takes, and compare to the bit");
    add_result_options(verb, choice->printed, ResultFigure::some);
    return [choice] { return analyse(*choice); };
}

}  // namespace

Verb experiment_analyse_verb() {
    return {.name = "analyse",
            .about = "analyse an experiment: tables (BIDS), tests, equivalence, and a report as HTML",
            .add = declare_experiment_analyse,
            .schema = [] { return report::schema_of_output({report::experiment_fields().schema()}); }};
}

}  // namespace tactus::command
