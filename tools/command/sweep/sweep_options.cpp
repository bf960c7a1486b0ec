// SPDX-License-Identifier: Apache-2.0
#include "tools/command/sweep/sweep_options.hpp"

#include "assets/file/part.hpp"
#include "tools/command/catalogue.hpp"
#include "tools/counted.hpp"
#include "tools/report/sweep/sweep_result.hpp"
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

std::string progress_text(const analysis::RunProgress& progress) {
    std::string text = fmt::format("{} of {}", progress.before + progress.finished, counted(progress.points, "point"));
    if (progress.failed > 0) text += fmt::format(", {} failed", progress.failed);
    if (progress.retried > 0) text += fmt::format(", {} tried again", progress.retried);
    if (progress.left)
        text += fmt::format("; {} to {} left", report::duration_text(progress.left->first),
                            report::duration_text(progress.left->second));
    if (progress.is_waiting_for_memory) text += "; fewer workers: memory is short";
    return text;
}

}  // namespace tactus::command
