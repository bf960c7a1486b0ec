// SPDX-License-Identifier: Apache-2.0
// tactus sweep run: prepares the folder of a sweep and runs it, here or on an engine.
#include "assets/file/json.hpp"
#include "assets/file/part.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/sweep/schedulers.hpp"
#include "tools/command/options.hpp"
#include "tools/command/sweep/sweep_options.hpp"
#include "tools/counted.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/report/sweep/sweep_result.hpp"
#include "tools/run/find_sweep.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/stop_signals.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>

namespace tactus::command {

namespace {

struct SweepRunChoice {
    std::string sweep, runner = "local";
    std::filesystem::path out;
    int jobs = 0, chunk = 0;
    std::vector<std::string> sbatch;
    bool is_dry = false, does_not_wait = false, json = false;
};

/// Writes the tables and reports; exit code.
int finish(const analysis::SweepFolder& folder, bool is_stopped, bool json) {
    const analysis::Results results(folder);
    results.write_csv(folder.path() / "results.csv");
    results.write_sqlite(folder.path() / "results.sqlite");
    const report::SweepState state(results);
    const report::Result result = report::sweep_state_fields().of(state);
    if (json) say(stdout, report::output_json(result).dump(2) + "\n");
    else say(stdout, fmt::format("{}table: {}\n", report::text_of(result), (folder.path() / "results.csv").string()));
    if (is_stopped) say(stderr, "tactus: ended early; the same command continues\n");
    return results.done() == results.size() ? done : answer_is_no;
}

int run_here(const analysis::SweepFolder& folder, const SweepRunChoice& choice) {
    analysis::LocalRun run = local_run(choice.jobs, "local");
    LiveLine line;
    run.tell = [&](const analysis::RunProgress& progress) { line.show(progress_text(progress)); };
    analysis::run_locally(folder, run);
    line.clear();
    return finish(folder, *run.stop, choice.json);
}

int run_on_slurm(const analysis::SweepFolder& folder, const SweepRunChoice& choice) {
    const analysis::SubmittedJob job = analysis::submit_to_slurm(
        folder, {static_cast<std::size_t>(choice.chunk), std::max(choice.jobs, 1), choice.sbatch, file::this_object()});
    if (job.id.empty()) return finish(folder, false, choice.json);
    if (!choice.json)
        say(stdout, fmt::format("job {}: {} of {}; 'scancel {}' ends it, and the same command continues\n", job.id,
                                counted(job.elements, "element"), counted(job.shares, "share"), job.id));
    if (choice.does_not_wait) return done;
    const std::atomic<bool>& stop = run::stop_on_signals();
    LiveLine line;
    constexpr int max_failures = 150;  // five minutes: Slurm's controller may be restarted meanwhile
    int failures = 0;
    for (std::size_t left = 1; left > 0 && !stop;) {
        try {
            left = analysis::elements_in_slurm(job.id);
            failures = 0;
        } catch (const Error&) {
            if (++failures == max_failures) throw;
        }
        if (line.is_terminal()) {
            const std::vector<bool> finished = analysis::finished_points(folder);
            line.show(fmt::format("{} of {}; {} in the queue", std::ranges::count(finished, true),
                                  counted(finished.size(), "point"), counted(left, "element")));
        }
        for (int i = 0; i < 20 && left > 0 && !stop; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    line.clear();
    if (stop) {
        say(stderr, fmt::format("tactus: job {} goes on; 'tactus sweep status {}' reports it\n", job.id,
                                folder.path().string()));
        return answer_is_no;
    }
    return finish(folder, false, choice.json);
}

int list_points(const analysis::SweepFolder& folder, bool json) {
    const std::vector<bool> finished = analysis::finished_points(folder);
    const auto ready = static_cast<std::size_t>(std::ranges::count(finished, true));
    if (json) {
        say(stdout,
            file::Json{{"points", finished.size()}, {"done", ready}, {"list", sweep::text_of_id(folder.tasks().hash())}}
                    .dump(2) +
                "\n");
        return done;
    }
    std::string text = fmt::format("{}, {} finished\n", counted(finished.size(), "point"), ready);
    for (const sweep::Axis& axis : folder.sweep().axes)
        text += fmt::format("  {}: {}, {} to {}\n", axis.name, counted(axis.levels.size(), "level"),
                            axis.levels.front().text, axis.levels.back().text);
    for (std::size_t i = 0; i < std::min<std::size_t>(finished.size(), 3); ++i)
        text += fmt::format("point {}: {}\n", i + 1, report::point_text(folder, i));
    say(stdout, text);
    return done;
}

int sweep_run(const SweepRunChoice& choice) {
    const analysis::SweepFolder folder(run::find_sweep(choice.sweep), choice.out, run::library_folder());
    if (choice.is_dry) return list_points(folder, choice.json);
    if (choice.runner == "slurm") return run_on_slurm(folder, choice);
    if (choice.runner == "local") return run_here(folder, choice);
    const std::size_t shares =
        analysis::write_makefile(folder, choice.chunk > 0 ? static_cast<std::size_t>(choice.chunk) : 100,
                                 std::max(choice.jobs, 1), file::this_object());
    say(stdout, fmt::format("{} with {}; run 'make -j 8 -k -C {}', then 'tactus sweep status {}'\n",
                            (folder.path() / "Makefile").string(), counted(shares, "target"), folder.path().string(),
                            folder.path().string()));
    return done;
}

Action declare_sweep_run(VerbOptions& verb) {
    const auto choice = std::make_shared<SweepRunChoice>();
    verb.add("sweep", choice->sweep, "sweep file, or a name in the library").required();
    verb.output("-o,--out", choice->out, OutputFormat::folder(), "folder of the sweep; an existing one is continued")
        .required();
    verb.add("--runner", choice->runner, "local: on this machine; slurm: as an array job; make: only write a Makefile")
        .one_of({"local", "slurm", "make"})
        .shows_default();
    verb.add("--jobs", choice->jobs, "workers, 0: one per core; of an array's element or a make target, default 1")
        .range(0, 1024);
    verb.add("--chunk", choice->chunk,
             "points of an array's element (default: 10, or what the largest array needs) or make target (100)")
        .range(1, 20'000'000);
    verb.add("--sbatch", choice->sbatch, "option for sbatch, as in --sbatch=--partition=short; may be given again")
        .one_each();
    verb.flag("--dry-run", choice->is_dry, "list axes and the first points, and run nothing");
    verb.flag("--no-wait", choice->does_not_wait, "with slurm: submit and return");
    verb.flag("--json", choice->json, "as JSON");
    return [choice] {
        try {
            return sweep_run(*choice);
        } catch (const analysis::LogFailure& failure) {
            say(stderr, fmt::format("tactus: {}\n", failure.what()));
            return static_cast<int>(machine_failed);
        }
    };
}

}  // namespace

Verb sweep_run_verb() {
    return {"run", "run a sweep, or what is left of it; exit code 1: a point failed or is left", declare_sweep_run};
}

}  // namespace tactus::command
