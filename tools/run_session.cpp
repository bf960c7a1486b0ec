// SPDX-License-Identifier: Apache-2.0
#include "tools/run_session.hpp"

#include "assets/file/whole_file.hpp"
#include "tools/load_plan.hpp"
#include "tools/results.hpp"
#include "tools/summary.hpp"

#include <fmt/format.h>

#include <chrono>

namespace tactus {

namespace {

// Without --seconds the run lasts until Ctrl-C; a day is as good as for ever and keeps every index small.
constexpr double for_ever = 86400.0;

}  // namespace

RunSession::RunSession(const RunChoice& choice, AssetCache& assets, Observer* observer)
    : choice_(choice), assets_(assets), folder_(choice.out) {
    EngineOptions options;
    options.seconds = choice.seconds.value_or(for_ever);
    options.live = true;
    options.observer = observer;
    options.audio = {choice.audio, choice.audio_margin * 1e-3};
    if (choice.dilate != 1.0) {
        if (options.audio.is_required())
            throw Error("a card plays at its own pace: --dilate needs --audio file or none");
        if (choice.audio.empty()) options.audio.device = "file";
    }
    if (folder_.empty()) folder_ = std::filesystem::path(choice.patch).stem().string() + "-run";
    options.folder = folder_;
    Plan plan = load_plan(choice, assets);
    make_output_folder(folder_);
    if (!choice.record.empty()) {
        take_ = make_take(choice, choice.record, options.seconds, true);
        options.take = take_.get();
    }
    engine_ = std::make_unique<Engine>(std::move(plan), options);
}

void RunSession::run(const Hooks& hooks, const std::atomic<bool>& stop) {
    LiveOptions live;
    live.dilate = choice_.dilate;
    if (!choice_.log.empty()) live.log = choice_.log;
    live.stop = &stop;
    if (choice_.edits) control_ = std::make_unique<LiveControl>(*engine_, choice_, assets_, hooks.say);
    live.watch = [&] {
        if (control_) control_->tend();
        if (hooks.tend) hooks.tend();
    };
    const auto begin = std::chrono::steady_clock::now();
    engine_->run_live(live);
    wall_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    control_.reset();
}

void RunSession::finish() {
    engine_->finish();
    const Report report = engine_->report();
    std::vector<std::string> files = write_pictures(report, folder_);
    for (std::string& file : write_bones(report, folder_)) files.push_back(std::move(file));
    files.push_back("summary.json");
    const double ran = engine_->progress_seconds();
    json_ = tactus::summary_json(*engine_, report, ran, true, files);
    text_ = tactus::summary_text(*engine_, report, ran, wall_s_);
    write_whole_file(folder_ / "summary.json", json_);
}

}  // namespace tactus
