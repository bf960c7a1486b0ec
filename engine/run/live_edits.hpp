// SPDX-License-Identifier: Apache-2.0
// Edits of a live run. A plan is built on a thread of its own and given to every group. All groups take it over at the same
// logical time. The plan before is destroyed when no group uses it any more.
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
        : seconds_(options.seconds), context_(context), timeline_(timeline), recorder_(recorder), time_(time), present_(time) {}
    ~LiveEdits();

    /// See Engine.
    void edit(std::function<compile::Plan()> make, std::function<void(const EditOutcome&)> told);
    /// A parameter of a sub-patch sets all that it stands for, or none when one of them cannot be set.
    Flicks set(const std::string& node, const std::string& param, const std::string& text);

    /// The threads that a plan needs.
    struct Threads {
        /// Makes those of new groups and of new devices; they wait. Throws when one is refused.
        std::function<void(const build::Generation&)> prepare;
        std::function<void()> release;  ///< they begin
        std::function<void()> cancel;  ///< they end, as if they had never been
        std::function<void(const GroupRuntime&)> end;
    };
    /// Takes the next step of the edit that is on its way.
    void service(const Threads& threads);
    bool is_building() const { return building_ != nullptr; }
    bool is_settled() const { return !waiting_ && !is_building() && !timeline_.is_changing(); }
    /// Waits for the thread that builds. False: a driver that it opens blocked it for a fifth of a second; it was left
    /// behind, and nothing that it refers to may be destroyed.
    bool end();

private:
    struct Edit {
        std::function<compile::Plan()> make;
        std::function<void(const EditOutcome&)> told;
    };
    /// A plan that is being built, or was.
    struct Building {
        std::thread thread;
        std::atomic<bool> is_done{false};
        std::unique_ptr<build::Generation> made;  // when done; null: `failure`
        std::string assets;  // as the take describes them
        std::exception_ptr failure;
    };
    /// A parameter of a node that runs, and its value from now on.
    struct Setting {
        std::size_t index = 0;  // of the node
        build::LiveNode* node = nullptr;
        Param* param = nullptr;
        double value = 0.0;
    };
    /// Throws Error when the node has no such parameter or may not be set.
    Setting setting_of(const std::string& node, const std::string& param, const std::string& text) const;
    void build();
    void work(Building& building, bool is_taken);
    void finish(const Threads& threads);
    EditOutcome hand_over(Building& built, const Threads& threads);
    void retire(const Threads& threads);
    /// Every group has left the plan before and has been between two calls since.
    bool is_before_left();
    void close_ended(const Threads& threads);
    /// How far ahead a parameter of a node is set. One that changes in one step is set while forces are held off.
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
    std::vector<std::int64_t> settled_at_;  // rests of each group when nothing read the plan before any more
    /// Changes of parameters, which may be of the plan before, that each group had been given by the switch.
    std::vector<std::pair<std::shared_ptr<GroupRuntime>, std::int64_t>> given_before_;
    std::int64_t changes_ = 0;
};

}  // namespace tactus::run
