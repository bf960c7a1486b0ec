// SPDX-License-Identifier: Apache-2.0
// tactus score: what an attempt at a task was like, in numbers and on a page.
#include "assets/table/csv_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/result_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/report/training/score_result.hpp"

#include <fmt/format.h>

#include <memory>

namespace tactus::command {

namespace {

namespace fs = std::filesystem;

struct ScoreChoice {
    std::vector<fs::path> runs, reference;
    fs::path task, csv;
    ResultChoice result;
};

std::vector<analysis::ScoredRun> scored(const std::vector<fs::path>& folders, const fs::path& task) {
    std::vector<analysis::ScoredRun> runs;
    for (const fs::path& folder : folders)
        for (const fs::path& attempt : analysis::attempts_in(folder))
            runs.push_back(analysis::score_run(attempt, task));
    return runs;
}

int score(const ScoreChoice& choice) {
    check_result_files(choice.result, {choice.task}, {choice.csv});
    const std::vector<analysis::ScoredRun> runs = scored(choice.runs, choice.task);
    const std::vector<analysis::ScoredRun> others = scored(choice.reference, choice.task);
    for (const analysis::ScoredRun& other : others)
        if (other.task.title != runs.back().task.title)
            throw Error(fmt::format("--reference {}: was at the task '{}', not at '{}'", other.name, other.task.title,
                                    runs.back().task.title));
    const std::vector<analysis::ReferenceMeasure> group =
        others.empty() ? std::vector<analysis::ReferenceMeasure>{} : analysis::reference_of(others);
    if (!choice.csv.empty()) table::save_csv(choice.csv, report::score_table(runs));
    report::ScoredRuns found{runs, group};
    if (choice.result.shows_figures()) found.pictures = report::pictures_of(runs.back());
    write_result(report::score_result(found), choice.result);
    return done;
}

Action declare_score(VerbOptions& verb) {
    const auto choice = std::make_shared<ScoreChoice>();
    verb.add("runs", choice->runs,
             "results of runs with a node 'task', takes, or attempts or whole sessions of 'tactus session', in the "
             "order of the attempts")
        .required();
    verb.add("--reference", choice->reference, "the same of a reference group, for percentiles; may be given again")
        .one_each();
    verb.add("--task", choice->task, "score by this task file in place of the one that the run names");
    add_result_options(verb, choice->result, ResultFigure::some);
    verb.find("--json").about("as JSON: an object for one run, rows for several");
    verb.old("--report", "--out");
    verb.output("--csv", choice->csv, {{".csv"}}, "write a table with a line per run to this file");
    return [choice] { return score(*choice); };
}

}  // namespace

Verb score_verb() {
    return {.name = "score",
            .about = "score attempts at a training task: plane, volumes, structures, force, strokes; not validated",
            .add = declare_score,
            .schema = [] { return report::schema_of_output(report::score_schemas()); }};
}

}  // namespace tactus::command
