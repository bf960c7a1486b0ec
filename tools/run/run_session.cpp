// SPDX-License-Identifier: Apache-2.0
#include "tools/run/run_session.hpp"

#include "graph/node/notice.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/results.hpp"
#include "tools/run/summary.hpp"

#include <fmt/format.h>

#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <utility>

namespace tactus::run {

namespace fs = std::filesystem;

namespace {

// Without --seconds the run lasts until Ctrl-C: a limit of 100 years, a quarter of what logical time in flicks can hold.
constexpr double for_ever = 100.0 * 365.25 * 86400.0;

/// The log must not have the path of a recording.
void check_log(const run::Engine& engine, const fs::path& log, const fs::path& folder) {
    std::error_code ignored;
    const fs::path file = fs::weakly_canonical(log, ignored);
    for (const auto& stream : engine.host().streams)
        if (!log.empty() && file == fs::weakly_canonical(folder / stream->format().file, ignored))
            throw Error(fmt::format("--log {}: the patch records to this file; choose another one", log.string()));
}

}  // namespace

RunSession::RunSession(const RunChoice& choice, compile::AssetCache& assets, observe::Observer* observer)
    : choice_(choice), assets_(assets) {
    run::EngineOptions options;
    options.seconds = choice.seconds.value_or(for_ever);
    options.live = true;
    options.observer = observer;
    options.tap = choice.tap;
    options.audio = {choice.audio, choice.audio_margin * 1e-3};
    if (choice.dilate != 1.0) {
        if (options.audio.is_required())
            throw Error("--dilate needs --audio file or none, because a sound card runs in real time");
        if (choice.audio.empty()) options.audio.device = "file";
    }
    compile::Schedule plan = load_plan(choice, assets);
    const bool is_default = choice.out.empty();
    folder_ = std::make_unique<OutputFolder>(
        OutputChoice{is_default ? fs::path(fs::path(choice.patch).stem().string() + "-run") : choice.out,
                     choice.overwrite, is_default || choice.is_further, is_default});
    options.folder = folder();
    if (!choice.record.empty()) {
        take_ = make_take(choice, choice.record, options.seconds, true);
        options.take = take_.get();
        if (!choice.record_values) take_->limit_values(take::max_first_bytes);
    } else if (choice.keeps_journal) begin_journal(options);
    engine_ = std::make_unique<run::Engine>(std::move(plan), options);
    check_log(*engine_, choice.log, folder());
}

RunSession::~RunSession() { drop_journal(); }

/// A take without values (journal), which can become a full take during the run.
void RunSession::begin_journal(run::EngineOptions& options) {
    constexpr std::string_view name = "journal-";
    std::error_code ignored;
    // Remains of killed runs.
    for (const auto& entry : fs::directory_iterator(folder(), ignored)) {
        const std::string file = entry.path().filename().string();
        if (!file.starts_with(name) || file.find_first_not_of("0123456789", name.size()) != file.npos) continue;
        const int owner = std::atoi(file.c_str() + name.size());
        if (owner > 0 && (owner == ::getpid() || ::kill(owner, 0) != 0)) fs::remove_all(entry.path(), ignored);
    }
    take_ = make_take(choice_, folder() / fmt::format("{}{}", name, ::getpid()), options.seconds, true);
    options.take = take_.get();
    options.take_values = run::TakeValues::on_request;
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
    run::LiveOptions live;
    live.dilate = choice_.dilate;
    if (!choice_.log.empty()) live.log = choice_.log;
    live.stop = &stop;
    if (choice_.edits) control_ = std::make_unique<LiveControl>(*engine_, choice_, assets_, hooks.say);
    live.watch = [&] {
        for (const std::string& line : take_notices(engine_->host()))
            if (hooks.say) hooks.say(line);
        if (control_) control_->tend();
        if (hooks.tend) hooks.tend();
    };
    engine_->run_live(live);
    control_.reset();
}

void RunSession::finish() {
    engine_->complete();
    drop_journal();
    const Report report = engine_->report();
    WrittenFiles written = write_results(report, folder());
    late_losses_ = std::move(written.losses);
    written.names.emplace_back("summary.json");
    const double ran = engine_->progress_seconds();
    json_ = run::summary_json(*engine_, report, ran, true, written.names, losses());
    text_ = run::summary_text(*engine_, report, ran, std::nullopt);
    try {
        folder_->write_summary(json_);
    } catch (const Error& error) {
        late_losses_.emplace_back(error.what());
    }
}

std::vector<std::string> RunSession::losses() const {
    std::vector<std::string> all = engine_->losses();
    all.insert(all.end(), late_losses_.begin(), late_losses_.end());
    return all;
}

}  // namespace tactus::run
