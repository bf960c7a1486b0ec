// SPDX-License-Identifier: Apache-2.0
// A live run on threads of its own, beside a window: what it tells is copied, what it is asked for is queued.
#pragma once

#include "engine/observe/observer.hpp"
#include "graph/compile/load_assets.hpp"
#include "tools/session/run_choice.hpp"

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace tactus::session {
class RunSession;
}

namespace tactus::view {

using session::RunChoice;
using session::RunSession;

struct GroupStatus {
    std::string name;
    double rate = 0.0;  ///< Hz
    std::int64_t ticks = 0, missed = 0;
    double late_p99_ms = 0.0, late_max_ms = 0.0, execution_us = 0.0, load = 0.0;  ///< load: of its period
};
struct NodeStatus {
    std::string name;
    double mean_us = 0.0, max_us = 0.0, share = 0.0;  ///< of the group's period
};

struct RunStatus {
    enum class State { loading, runs, fades, stands, over } state = State::loading;
    double time = 0.0;  ///< logical, s
    double force = 0.0;  ///< on the hand, N
    std::vector<GroupStatus> groups;
    std::vector<NodeStatus> nodes;
    std::vector<std::string> faults;
    std::int64_t edits = 0;
    bool is_recording = false;
    std::string failure;  ///< why it is over before its time
};

class ViewedRun {
public:
    /// Starts at once; loading happens on its own thread.
    ViewedRun(RunChoice choice, compile::AssetCache& assets, observe::Observer& observer);
    /// Ends the run and waits for it.
    ~ViewedRun();

    /// At most a tenth of a second old.
    std::shared_ptr<const RunStatus> status() const;
    /// What was said since the last call.
    std::vector<std::string> messages();
    /// The patch's file was saved since the last call.
    bool file_was_saved() { return saved_.exchange(false); }
    bool is_over() const { return over_; }

    void set(const std::string& node, const std::string& param, const std::string& value);
    void edit(const std::string& text);
    void pause(bool wanted);
    /// From now on, in that folder when it is the first time.
    void record(const std::filesystem::path& folder);
    void stop_recording();
    void stop() { stop_ = true; }

    /// After its end: what the command prints.
    std::string summary_json() const, summary_text() const;
    /// What it could not write to its end, and why; after it is over.
    std::vector<std::string> losses() const;

private:
    void work();
    void tend(RunSession& session);
    void look_at(RunSession& session);
    void end(const std::string& failure);
    void say(const std::string& text);
    void ask(std::function<void(RunSession&)> what);

    RunChoice choice_;
    compile::AssetCache& assets_;
    observe::Observer& observer_;
    mutable std::mutex lock_;
    std::vector<std::function<void(RunSession&)>> asked_;
    std::vector<std::string> messages_;
    std::shared_ptr<const RunStatus> status_ = std::make_shared<RunStatus>();
    int tends_ = 0;
    std::size_t told_notices_ = 0;
    std::string json_, text_;
    std::vector<std::string> losses_;
    std::unique_ptr<RunSession> session_;  // also when it is over: what was seen last stays to be seen
    std::atomic<bool> stop_{false}, over_{false}, saved_{false};
    std::thread thread_;
};

}  // namespace tactus::view
