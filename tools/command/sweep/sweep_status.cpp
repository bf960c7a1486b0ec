// SPDX-License-Identifier: Apache-2.0
// tactus sweep status: how far a sweep is, whoever runs it.
#include "tools/command/options.hpp"
#include "tools/command/result_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/report/sweep/sweep_result.hpp"
#include "tools/run/load_plan.hpp"

#include <memory>

namespace tactus::command {

namespace {

struct SweepStatusChoice {
    std::filesystem::path folder;
    bool writes_tables = false;
    ResultChoice result;
};

int sweep_status(const SweepStatusChoice& choice) {
    check_result_files(choice.result, {});
    const analysis::SweepFolder folder(choice.folder, run::library_folder());
    const analysis::Results results(folder);
    write_result(report::sweep_state_fields().of(report::SweepState(results)), choice.result);
    if (choice.writes_tables) {
        results.write_csv(folder.path() / "results.csv");
        results.write_sqlite(folder.path() / "results.sqlite");
    }
    return results.done() == results.size() && results.conflicts().empty() ? done : answer_is_no;
}

Action declare_sweep_status(VerbOptions& verb) {
    const auto choice = std::make_shared<SweepStatusChoice>();
    verb.add("folder", choice->folder, "folder of a sweep").required();
    verb.flag("--tables", choice->writes_tables, "write results.csv and results.sqlite from the logs as they are");
    add_result_options(verb, choice->result, ResultFigure::none);
    return [choice] { return sweep_status(*choice); };
}

}  // namespace

Verb sweep_status_verb() {
    return {.name = "status",
            .about = "progress of a sweep, failures first; exit code 1: points failed or are left",
            .add = declare_sweep_status,
            .schema = [] { return report::schema_of_output({report::sweep_state_fields().schema()}); }};
}

}  // namespace tactus::command
