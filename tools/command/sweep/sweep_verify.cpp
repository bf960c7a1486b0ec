// SPDX-License-Identifier: Apache-2.0
// tactus sweep verify: runs a sample of the points again and compares.
#include "assets/file/part.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/sweep/provenance.hpp"
#include "tools/analysis/sweep/verify.hpp"
#include "tools/command/options.hpp"
#include "tools/command/sweep/sweep_options.hpp"
#include "tools/counted.hpp"
#include "tools/exit_code.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/stop_signals.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <memory>

namespace tactus::command {

namespace {

struct SweepVerifyChoice {
    std::filesystem::path folder;
    std::string sample = "5%";
    int seed = 1;
};

/// "5%" → 0.05.
double fraction_of(const std::string& text) {
    double percent = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), percent);
    if (failure != std::errc{} || std::string_view(end) != "%" || !(percent > 0.0 && percent <= 100.0))
        throw Error(fmt::format("--sample must be a percentage above 0, as in 5%, not '{}'", text));
    return 0.01 * percent;
}

int sweep_verify(const SweepVerifyChoice& choice) {
    const analysis::SweepFolder folder(choice.folder, run::library_folder());
    const analysis::Results results(folder);
    const std::vector<std::size_t> points =
        analysis::sample_points(results, fraction_of(choice.sample), static_cast<std::uint64_t>(choice.seed));
    if (points.empty()) throw Error(fmt::format("{}: no point is finished yet", folder.path().string()));
    LiveLine line;
    const analysis::Verification found = analysis::verify_points(
        results, points, analysis::worker_description(version_text("tactus"), "verify", 1), file::this_object(),
        run::stop_on_signals(),
        [&](std::size_t n) { line.show(fmt::format("{} of {}", n, counted(points.size(), "point"))); });
    line.clear();
    for (const std::string& difference : found.differences) say(stderr, fmt::format("tactus: {}\n", difference));
    std::string text = fmt::format("{} run again: {} equal", counted(points.size(), "point"), found.equal);
    if (found.equal_elsewhere > 0)
        text += fmt::format(" ({} of them on another build or processor)", found.equal_elsewhere);
    text += fmt::format(", {} different", found.differences.size());
    if (found.not_comparable > 0)
        text += fmt::format(", {} not comparable: made with another {}", found.not_comparable,
                            fmt::join(found.reasons, " or "));
    say(stdout, text + "\n");
    const bool is_whole = found.equal + found.not_comparable + found.differences.size() == points.size();
    if (!is_whole) say(stderr, "tactus: ended early\n");
    return found.differences.empty() && is_whole ? done : answer_is_no;
}

Action declare_sweep_verify(VerbOptions& verb) {
    const auto choice = std::make_shared<SweepVerifyChoice>();
    verb.add("folder", choice->folder, "folder of a sweep").required();
    verb.add("--sample", choice->sample, "percentage of the finished points").shows_default();
    verb.add("--seed", choice->seed, "of the choice of points").shows_default().range(0, 1'000'000'000);
    return [choice] { return sweep_verify(*choice); };
}

}  // namespace

Verb sweep_verify_verb() {
    return {"verify", "run finished points again in fresh processes and compare; exit code 1: an output differs",
            declare_sweep_verify};
}

}  // namespace tactus::command
