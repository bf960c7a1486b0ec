// SPDX-License-Identifier: Apache-2.0
#include "tools/command/sweep/sweep_options.hpp"

#include "assets/file/part.hpp"
#include "tools/command/catalogue.hpp"
#include "tools/counted.hpp"
#include "tools/run/shell_word.hpp"
#include "tools/run/stop_signals.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::command {

int run_verb_here(const std::vector<std::string>& words) {
    std::vector<std::string> all{"tactus"};
    all.insert(all.end(), words.begin(), words.end());
    std::vector<char*> argv;
    for (std::string& word : all) argv.push_back(word.data());
    return command_line(tactus_program(), static_cast<int>(argv.size()), argv.data());
}

analysis::LocalRun local_run(int jobs, const std::string& runner) {
    analysis::LocalRun run;
    run.jobs = jobs;
    run.runner = runner;
    run.version = version_text("tactus");
    run.program = file::this_object();
    run.run_verb = run_verb_here;
    run.stop = &run::stop_on_signals();
    return run;
}

std::string duration_text(double seconds) {
    if (seconds < 90.0) return fmt::format("{:.0f} s", seconds);
    if (seconds < 90.0 * 60.0) return fmt::format("{:.1f} min", seconds / 60.0);
    if (seconds < 36.0 * 3600.0) return fmt::format("{:.1f} h", seconds / 3600.0);
    return fmt::format("{:.1f} days", seconds / 86400.0);
}

std::string progress_text(const analysis::RunProgress& progress) {
    std::string text = fmt::format("{} of {}", progress.before + progress.finished, counted(progress.points, "point"));
    if (progress.failed > 0) text += fmt::format(", {} failed", progress.failed);
    if (progress.retried > 0) text += fmt::format(", {} tried again", progress.retried);
    if (progress.left)
        text +=
            fmt::format("; {} to {} left", duration_text(progress.left->first), duration_text(progress.left->second));
    if (progress.is_waiting_for_memory) text += "; fewer workers: memory is short";
    return text;
}

std::string results_text(const analysis::Results& results) {
    std::string text;
    for (const analysis::Results::Failure& failure : results.failures())
        text += fmt::format("failed: {}: {}\n  such as point {}: {}\n", counted(failure.count, "point"), failure.reason,
                            failure.example + 1, point_text(results.folder(), failure.example, failure.step));
    for (const std::string& conflict : results.conflicts()) text += fmt::format("conflict: {}\n", conflict);
    text += fmt::format("{} of {} done, {} failed, {} to run\n", results.done(), counted(results.size(), "point"),
                        results.failed(), results.unfinished());
    if (results.repeated() > results.conflicts().size())
        text += fmt::format("{} run more than once, with equal results\n",
                            counted(results.repeated() - results.conflicts().size(), "point"));
    if (results.foreign() > 0)
        text +=
            fmt::format("{} in the logs of points that the sweep no longer has\n", counted(results.foreign(), "row"));
    if (results.damaged() > 0)
        text += fmt::format("{} in the logs ignored\n", counted(results.damaged(), "damaged line"));
    return text;
}

std::string point_text(const analysis::SweepFolder& folder, std::size_t index, int step) {
    const sweep::Sweep& sweep = folder.sweep();
    if (sweep.steps.empty()) return "no step";
    const sweep::Step& shown =
        sweep.steps[std::min(sweep.steps.size(), static_cast<std::size_t>(std::max(step, 1))) - 1];
    std::string text = shown.is_own ? "tactus" : "";
    for (const std::string& word :
         sweep::words_of(sweep, shown, folder.tasks().point(index), folder.tasks().id(index), "OUT", "tactus"))
        text += (text.empty() ? "" : " ") + run::short_shell_word(word);
    return text;
}

}  // namespace tactus::command
