// SPDX-License-Identifier: Apache-2.0
#include "tools/session/run_session.hpp"

#include "assets/file/whole_file.hpp"
#include "tools/session/load_plan.hpp"
#include "tools/session/results.hpp"
#include "tools/session/summary.hpp"

#include <fmt/format.h>

#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <utility>

namespace tactus::session {

namespace fs = std::filesystem;

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
    } else if (choice.keeps_journal) begin_journal(options);
    engine_ = std::make_unique<Engine>(std::move(plan), options);
}

RunSession::~RunSession() { drop_journal(); }

/// A take without values, which becomes one with them when that is asked for.
void RunSession::begin_journal(EngineOptions& options) {
    constexpr std::string_view name = "journal-";
    std::error_code ignored;
    // What runs that were killed have left.
    for (const auto& entry : fs::directory_iterator(folder_, ignored)) {
        const std::string file = entry.path().filename().string();
        if (!file.starts_with(name)) continue;
        const int owner = std::atoi(file.c_str() + name.size());
        if (owner > 0 && (owner == ::getpid() || ::kill(owner, 0) != 0)) fs::remove_all(entry.path(), ignored);
    }
    take_ = make_take(choice_, folder_ / fmt::format("{}{}", name, ::getpid()), options.seconds, true);
    options.take = take_.get();
    options.record_values = false;
    is_journal_ = true;
}

void RunSession::drop_journal() {
    if (!std::exchange(is_journal_, false)) return;
    std::error_code ignored;
    fs::remove_all(take_->folder(), ignored);
}

void RunSession::record(const fs::path& folder) {
    engine_->record(true);
    if (!is_journal_) return;
    try {
        take_->move_to(folder);
        is_journal_ = false;
    } catch (const Error&) {
        engine_->record(false);
        throw;
    }
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
    drop_journal();
    const Report report = engine_->report();
    std::vector<std::string> files = write_pictures(report, folder_);
    for (std::string& file : write_bones(report, folder_)) files.push_back(std::move(file));
    files.push_back("summary.json");
    const double ran = engine_->progress_seconds();
    json_ = session::summary_json(*engine_, report, ran, true, files);
    text_ = session::summary_text(*engine_, report, ran, wall_s_);
    write_whole_file(folder_ / "summary.json", json_);
}

}  // namespace tactus::session
