// SPDX-License-Identifier: Apache-2.0
// tactus score: what an attempt at a task was like, in numbers and on a page.
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/batch.hpp"
#include "tools/command/options.hpp"
#include "tools/command/training/score_text.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/figures/training_page.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <memory>

namespace tactus::command {

namespace {

namespace fs = std::filesystem;

struct ScoreChoice {
    std::vector<fs::path> runs, reference;
    fs::path task, report, csv;
    bool json = false;
};

std::vector<analysis::ScoredRun> scored(const std::vector<fs::path>& folders, const fs::path& task) {
    std::vector<analysis::ScoredRun> runs;
    for (const fs::path& folder : folders)
        for (const fs::path& attempt : analysis::attempts_in(folder))
            runs.push_back(analysis::score_run(attempt, task));
    return runs;
}

int score(const ScoreChoice& choice) {
    const std::vector<analysis::ScoredRun> runs = scored(choice.runs, choice.task);
    const std::vector<analysis::ScoredRun> others = scored(choice.reference, choice.task);
    for (const analysis::ScoredRun& other : others)
        if (other.task.title != runs.back().task.title)
            throw Error(fmt::format("--reference {}: was at the task '{}', not at '{}'", other.name, other.task.title,
                                    runs.back().task.title));
    const std::vector<analysis::ReferenceMeasure> group =
        others.empty() ? std::vector<analysis::ReferenceMeasure>{} : analysis::reference_of(others);
    if (!choice.csv.empty()) file::write_whole_file(choice.csv, score_csv(runs));
    if (!choice.report.empty()) file::write_whole_file(choice.report, report::training_page(runs, group));
    say(stdout, choice.json ? score_json(runs, group) : score_text(runs, group));
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
    verb.add("--report", choice->report, "write a page with pictures to this .html file");
    verb.add("--csv", choice->csv, "write a table with a line per run to this file");
    verb.flag("--json", choice->json, "as JSON: an object for one run, rows for several");
    return [choice] { return score(*choice); };
}

}  // namespace

Verb score_verb() {
    return {"score", "score attempts at a training task: plane, volumes, structures, force, strokes; not validated",
            declare_score};
}

}  // namespace tactus::command
