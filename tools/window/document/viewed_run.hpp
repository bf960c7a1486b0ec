// SPDX-License-Identifier: Apache-2.0
// A live run on its own threads beside a window: status is copied, commands are queued.
#pragma once

#include "devices/haptic/pulled_hand.hpp"
#include "engine/observe/observer.hpp"
#include "graph/compile/load_assets.hpp"
#include "tools/run/force_news.hpp"
#include "tools/run/run_choice.hpp"

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace tactus::run {
class RunSession;
}
namespace tactus::plan {
struct CasePlan;
}

namespace tactus::window {

using run::RunChoice;
using run::RunSession;

struct GroupStatus {
    std::string name;
    double rate = 0.0;  ///< Hz
    std::int64_t ticks = 0, missed = 0;
    double late_p99_ms = 0.0, late_max_ms = 0.0, execution_us = 0.0, load = 0.0;  ///< load: fraction of the period
};
struct NodeStatus {
    std::string name;
    double mean_us = 0.0, max_us = 0.0, share = 0.0;  ///< share: fraction of the group's period
};

/// A device that tells where a person wants the hand that it pulls.
struct DevicePull {
    std::string device;
    std::shared_ptr<const haptic::PullLink> link;
};

struct RunStatus {
    enum class State { loading, runs, fades, stands, over } state = State::loading;
    double time = 0.0;  ///< logical, s
    double force = 0.0;  ///< force on the hand, N
    double most = 0.0;   ///< largest since the status before, N
    double peak = 0.0;   ///< largest of the run so far, N
    std::vector<GroupStatus> groups;
    std::vector<NodeStatus> nodes;
    std::vector<DevicePull> pulls;
    std::vector<run::HandForces> forces;
    std::vector<run::FaultOnRecord> faults;
    std::int64_t edits = 0;
    bool is_recording = false;
    std::filesystem::path folder;  ///< of its results; empty while it loads
    std::shared_ptr<const plan::CasePlan> plan;  ///< newest version of the plan that it changes; null: there is none
    std::string failure;  ///< why it ended early; empty: it did not
};

class ViewedRun {
public:
    /// Starts at once; loads on its own thread.
    ViewedRun(RunChoice choice, compile::AssetCache& assets, observe::Observer& observer);
    /// Ends the run and waits for it.
    ~ViewedRun();

    /// At most a tenth of a second old.
    std::shared_ptr<const RunStatus> status() const;
    /// Messages since the last call.
    std::vector<std::string> messages();
    /// True when the patch file was saved since the last call.
    bool file_was_saved() { return saved_.exchange(false); }
    bool is_over() const { return over_; }

    void set(const std::string& node, const std::string& param, const std::string& value);
    void edit(const std::string& text);
    /// The patch was saved as another file, which is watched from now on.
    void move_to(const std::filesystem::path& file);
    void pause(bool wanted);
    /// Lets forces return that stay off until a person asks for them; `node`: HandForces::node.
    void recover(const std::string& node);
    /// Presses a button that is a node of the patch.
    void press(const std::string& node);
    /// Starts recording; the first call sets the folder.
    void record(const std::filesystem::path& folder);
    void stop_recording();
    void stop() { stop_ = true; }

    /// The summary for the command, after the end.
    std::string summary_json() const, summary_text() const;
    /// Files that could not be completed, and why; after the end.
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
    run::ForceNews news_{choice_.edits ? run::LetReturn::by_set : run::LetReturn::by_button};
    double peak_ = 0.0;  // force of the run so far, N
    std::string json_, text_;
    std::vector<std::string> losses_;
    std::unique_ptr<RunSession> session_;  // kept after the end, so that the last values stay visible
    std::atomic<bool> stop_{false}, over_{false}, saved_{false};
    std::thread thread_;
};

}  // namespace tactus::window
