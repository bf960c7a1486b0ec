// SPDX-License-Identifier: Apache-2.0
// Edits of a live run. A plan is built on a separate thread and passed to every group. All groups switch to it at the
// same logical time. The previous plan is destroyed when no group uses it any more.
#pragma once

#include "engine/run/live_time.hpp"
#include "engine/run/recorder.hpp"
#include "engine/run/timeline.hpp"

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace tactus::run {

/// Control thread.
class LiveEdits {
public:
    LiveEdits(const EngineOptions& options, build::BuildContext& context, Timeline& timeline, Recorder& recorder,
              LiveTime& time)
        : seconds_(options.seconds),
          context_(context),
          timeline_(timeline),
          recorder_(recorder),
          time_(time),
          present_(time) {}
    ~LiveEdits();

    /// See Engine.
    void edit(std::function<compile::Schedule()> make, std::function<void(const EditOutcome&)> told);
    /// Setting a parameter of a sub-patch sets all inner parameters that it controls, or none if one of them cannot be
    /// set.
    Flicks set(const std::string& node, const std::string& param, const std::string& text);

    /// Callbacks that manage the threads of a plan.
    struct Threads {
        /// Creates the threads of new groups and new devices; they wait. Throws when the system refuses one.
        std::function<void(const build::Generation&)> prepare;
        std::function<void()> release;  ///< starts the waiting threads
        std::function<void()> cancel;  ///< ends the waiting threads
        std::function<void(const GroupRuntime&)> end;
    };
    /// Performs the next step of the edit in progress.
    void service(const Threads& threads);
    bool is_building() const { return building_ != nullptr; }
    bool is_settled() const { return !waiting_ && !is_building() && !timeline_.is_changing(); }
    /// Waits for the building thread. Returns false if a driver that it opens blocked it for a fifth of a second; then
    /// it was abandoned, and nothing that it refers to may be destroyed.
    bool end();

private:
    struct Edit {
        std::function<compile::Schedule()> make;
        std::function<void(const EditOutcome&)> told;
    };
    /// The state of building a plan.
    struct Building {
        std::thread thread;
        std::atomic<bool> is_done{false};
        std::unique_ptr<build::Generation> made;  // when done; null: `failure`
        std::string assets;  // as described for the take
        std::exception_ptr failure;
    };
    /// A parameter of a running node, and its new value.
    struct Setting {
        std::size_t index = 0;  // of the node
        build::LiveNode* node = nullptr;
        Param* param = nullptr;
        double value = 0.0;
    };
    /// Throws Error if the node has no such parameter or if it must not be set.
    Setting setting_of(const std::string& node, const std::string& param, const std::string& text) const;
    void build();
    void work(Building& building, bool is_taken);
    void finish(const Threads& threads);
    EditOutcome hand_over(Building& built, const Threads& threads);
    void retire(const Threads& threads);
    /// True if every group has left the previous plan and has been between two calls since.
    bool is_before_left();
    void close_ended(const Threads& threads);
    /// Lead time for setting a parameter of a node. One that changes in one step is set while forces are suspended.
    Flicks lead_of_set(const build::Generation& now, std::size_t node, const Param& param);
    void tell(const EditOutcome& outcome) const;

    const double seconds_;
    build::BuildContext& context_;
    Timeline& timeline_;
    Recorder& recorder_;
    LiveTime& time_;
    Present present_;
    std::optional<Edit> waiting_, making_;
    std::unique_ptr<Building> building_;
    std::vector<std::int64_t> settled_at_;  // rests of each group when the previous plan was no longer read
    /// Number of parameter changes, possibly of the previous plan, that each group had received by the switch.
    std::vector<std::pair<std::shared_ptr<GroupRuntime>, std::int64_t>> given_before_;
    std::int64_t changes_ = 0;
};

}  // namespace tactus::run
