// SPDX-License-Identifier: Apache-2.0
// tactus sweep status: how far a sweep is, whoever runs it.
#include "assets/file/json.hpp"
#include "tools/command/options.hpp"
#include "tools/command/sweep/sweep_options.hpp"
#include "tools/counted.hpp"
#include "tools/exit_code.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace tactus::command {

namespace {

struct SweepStatusChoice {
    std::filesystem::path folder;
    bool writes_tables = false, json = false;
};

int sweep_status(const SweepStatusChoice& choice) {
    const analysis::SweepFolder folder(choice.folder, run::library_folder());
    const analysis::Results results(folder);
    const std::optional<double> mean = results.mean_seconds();
    const std::size_t workers = results.unfinished() > 0 ? results.active_workers() : 0;
    const double work = mean.value_or(0.0) * static_cast<double>(results.unfinished());
    if (choice.json) {
        file::Json json{
            {"points", results.size()},
            {"done", results.done()},
            {"failed", results.failed()},
            {"unfinished", results.unfinished()},
            {"repeated", results.repeated()},
            {"damaged_lines", results.damaged()},
            {"conflicts", results.conflicts()},
            {"workers", workers},
            {"seconds_per_point", mean ? file::Json(*mean) : file::Json()},
            {"seconds_left", mean && workers > 0 ? file::Json(work / static_cast<double>(workers)) : file::Json()},
            {"hash", fmt::format("{:016x}", results.hash())},
            {"failures", file::Json::array()}};
        for (const analysis::Results::Failure& failure : results.failures())
            json["failures"].push_back(
                {{"reason", failure.reason}, {"points", failure.count}, {"example", failure.example + 1}});
        say(stdout, json.dump(2) + "\n");
    } else {
        std::string text = results_text(results);
        if (mean && results.unfinished() > 0)
            text += fmt::format(
                "a point takes {:.3g} s; {}\n", *mean,
                workers > 0
                    ? fmt::format("about {} left with {} that wrote in the last minutes",
                                  duration_text(work / static_cast<double>(workers)), counted(workers, "worker"))
                    : fmt::format("no worker wrote in the last minutes; {} of work are left", duration_text(work)));
        text += fmt::format("results {:016x}\n", results.hash());
        say(stdout, text);
    }
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
    verb.flag("--json", choice->json, "as JSON");
    return [choice] { return sweep_status(*choice); };
}

}  // namespace

Verb sweep_status_verb() {
    return {"status", "progress of a sweep, failures first; exit code 1: points failed or are left",
            declare_sweep_status};
}

}  // namespace tactus::command
