// SPDX-License-Identifier: Apache-2.0
#include "assets/file/whole_file.hpp"
#include "tools/live_control.hpp"
#include "tools/live_table.hpp"
#include "tools/load_plan.hpp"
#include "tools/results.hpp"
#include "tools/summary.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <csignal>

namespace tactus {

namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

// Without --seconds the run lasts until Ctrl-C; a day is as good as for ever and keeps every index small.
constexpr double for_ever = 86400.0;

}  // namespace

int run_verb(const RunChoice& choice) {
    EngineOptions options;
    options.seconds = choice.seconds.value_or(for_ever);
    options.live = true;
    options.audio = {choice.audio, choice.audio_margin * 1e-3};
    if (choice.dilate != 1.0) {
        if (options.audio.is_required())
            throw Error("a card plays at its own pace: --dilate needs --audio file or none");
        if (choice.audio.empty()) options.audio.device = "file";
    }
    std::filesystem::path folder = choice.out;
    if (folder.empty()) folder = std::filesystem::path(choice.patch).stem().string() + "-run";
    options.folder = folder;
    AssetCache assets;
    Plan plan = load_plan(choice, assets);
    make_output_folder(folder);
    std::unique_ptr<TakeWriter> take;
    if (!choice.record.empty()) {
        take = make_take(choice, choice.record, options.seconds, true);
        options.take = take.get();
    }
    Engine engine(std::move(plan), options);

    LiveLine line;
    auto next_table = std::chrono::steady_clock::now();
    LiveOptions live;
    live.dilate = choice.dilate;
    if (!choice.log.empty()) live.log = choice.log;
    live.stop = &interrupted;
    std::optional<LiveControl> control;
    if (choice.edits)
        control.emplace(engine, choice, assets, [&line](const std::string& said) {
            line.clear();
            fmt::print(stderr, "{}\n", said);
        });
    live.watch = [&] {
        if (control) control->tend();
        const auto now = std::chrono::steady_clock::now();
        if (choice.json || !line.is_terminal() || now < next_table) return;
        next_table = now + std::chrono::milliseconds(200);
        line.show(live_table(engine));
    };
    std::signal(SIGINT, [](int) { interrupted = true; });
    std::signal(SIGTERM, [](int) { interrupted = true; });
    if (!choice.json)
        fmt::print(stderr, "running {} for {}; Ctrl-C ends it\n", engine.plan().patch.title,
                   choice.seconds ? fmt::format("{} s", *choice.seconds) : "as long as you like");
    const auto begin = std::chrono::steady_clock::now();
    engine.run_live(live);
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    line.clear();
    engine.finish();
    const Report report = engine.report();
    std::vector<std::string> files = write_pictures(report, folder);
    for (std::string& file : write_bones(report, folder)) files.push_back(std::move(file));
    files.push_back("summary.json");
    const double ran = engine.progress_seconds();
    const std::string summary = summary_json(engine, report, ran, true, files);
    write_whole_file(folder / "summary.json", summary);
    if (choice.json) fmt::print("{}", summary);
    else fmt::print("{}  results in {}/\n", summary_text(engine, report, ran, wall), folder.string());
    return done;
}

}  // namespace tactus
