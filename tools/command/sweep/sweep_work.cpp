// SPDX-License-Identifier: Apache-2.0
// tactus sweep work: runs one share of a prepared sweep; schedulers and mpirun call it.
#include "tools/command/options.hpp"
#include "tools/command/sweep/sweep_options.hpp"
#include "tools/counted.hpp"
#include "tools/exit_code.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <memory>

namespace tactus::command {

namespace {

struct SweepWorkChoice {
    std::filesystem::path folder;
    std::string share;
    int jobs = 1;
};

/// "slurm 17_3", "share 2/8" or "work".
std::string runner_of(const std::optional<analysis::Share>& share) {
    const char* job = std::getenv("SLURM_ARRAY_JOB_ID");
    const char* element = std::getenv("SLURM_ARRAY_TASK_ID");
    if (job && element) return fmt::format("slurm {}_{}", job, element);
    if (const char* plain = std::getenv("SLURM_JOB_ID")) return fmt::format("slurm {}", plain);
    return share ? fmt::format("share {}/{}", share->index + 1, share->count) : "work";
}

int sweep_work(const SweepWorkChoice& choice) {
    const analysis::SweepFolder folder(choice.folder, run::library_folder());
    const std::optional<analysis::Share> share =
        choice.share.empty() ? analysis::share_of_environment() : std::optional(analysis::parse_share(choice.share));
    analysis::LocalRun run = local_run(choice.jobs, runner_of(share));
    run.share = share.value_or(analysis::Share{});
    // This process runs one of many shares: 'sweep run' or 'sweep status --tables' writes the tables.
    run.writes_tables = false;
    LiveLine line;
    run.tell = [&](const analysis::RunProgress& progress) { line.show(progress_text(progress)); };
    const analysis::RunProgress progress = analysis::run_locally(folder, run);
    line.clear();
    say(stdout, fmt::format("share {}/{}: {}{}\n", run.share.index + 1, run.share.count,
                            counted(progress.finished - progress.failed, "point"),
                            progress.failed > 0 ? fmt::format(", {} failed", progress.failed) : std::string()));
    return progress.failed == 0 && progress.before + progress.finished == progress.points ? done : answer_is_no;
}

Action declare_sweep_work(VerbOptions& verb) {
    const auto choice = std::make_shared<SweepWorkChoice>();
    verb.add("folder", choice->folder, "folder of a sweep, made by 'sweep run'").required();
    verb.add("--share", choice->share,
             "I/N: the I-th of N runners; default: rank and size of mpirun, MPICH or srun, otherwise all points")
        .value_name("I/N");
    verb.add("--jobs", choice->jobs, "workers; 0: one per core").range(0, 1024).shows_default();
    return [choice] {
        try {
            return sweep_work(*choice);
        } catch (const analysis::LogFailure& failure) {
            say(stderr, fmt::format("tactus: {}\n", failure.what()));
            return static_cast<int>(machine_failed);
        }
    };
}

}  // namespace

Verb sweep_work_verb() { return {"work", "run one share of a sweep, for schedulers and mpirun", declare_sweep_work}; }

}  // namespace tactus::command
