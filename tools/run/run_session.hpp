// SPDX-License-Identifier: Apache-2.0
// One live run, from the patch's text to the summary.
#pragma once

#include "engine/run/engine.hpp"
#include "tools/run/live_control.hpp"
#include "tools/run/output_folder.hpp"
#include "tools/run/run_choice.hpp"

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::run {

class RunSession {
public:
    /// Loads the patch and its assets and prepares all nodes; `observer` may be null. Throws Error.
    RunSession(const RunChoice& choice, compile::AssetCache& assets, observe::Observer* observer = nullptr);
    ~RunSession();

    struct Hooks {
        std::function<void()> tend;  ///< called about every 20 ms on the running thread
        std::function<void(const std::string&)> say;
    };
    /// Runs until the end time, or until `stop` is set. Throws Error.
    void run(const Hooks& hooks, const std::atomic<bool>& stop);
    /// Called from Hooks::tend: starts or stops recording. The first start uses the given folder. Throws Error.
    void record(const std::filesystem::path& folder);
    void stop_recording() { engine_->record(false); }
    /// Completes recordings and writes images, bones and the summary. Failed writes are added to the losses.
    void finish();
    /// Files that could not be completed, with the reason; grows during the run.
    std::vector<std::string> losses() const;

    run::Engine& engine() { return *engine_; }
    /// Null unless the run is active and accepts edits.
    LiveControl* control() { return control_.get(); }
    const std::filesystem::path& folder() const { return folder_->path(); }
    /// Valid after `finish`.
    const std::string& summary_json() const { return json_; }
    const std::string& summary_text() const { return text_; }

private:
    void begin_journal(run::EngineOptions& options);
    void drop_journal();

    RunChoice choice_;
    compile::AssetCache& assets_;
    std::unique_ptr<OutputFolder> folder_;
    std::vector<std::string> late_losses_;  // of files written after the run
    bool is_journal_ = false;  // the take contains only a journal so far
    std::unique_ptr<take::TakeWriter> take_;
    std::unique_ptr<run::Engine> engine_;
    std::unique_ptr<LiveControl> control_;
    std::string json_, text_;
};

}  // namespace tactus::run
