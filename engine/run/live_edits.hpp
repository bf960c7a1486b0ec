// SPDX-License-Identifier: Apache-2.0
// Edits of a live run. A plan is built on a thread of its own and handed to every group; each takes it over at the same
// logical time. The old plan is taken apart when no group can touch it any more.
#pragma once

#include "engine/run/recorder.hpp"
#include "engine/run/timeline.hpp"

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::run {

/// Control thread.
class LiveEdits {
public:
    LiveEdits(const EngineOptions& options, build::BuildContext& context, Timeline& timeline, Recorder& recorder)
        : seconds_(options.seconds), context_(context), timeline_(timeline), recorder_(recorder) {}

    /// See Engine.
    void edit(std::function<compile::Plan()> make, std::function<void(const EditOutcome&)> told);
    Flicks set(const std::string& node, const std::string& param, const std::string& text);

    /// Starts and ends the threads of groups.
    struct Threads {
        std::function<void(GroupRuntime&)> start;
        std::function<void(const GroupRuntime&)> end;
    };
    /// Takes the next step of the edit that is on its way.
    void service(const Threads& threads);
    bool is_building() const { return building_.valid(); }
    bool is_settled() const { return !waiting_ && !is_building() && !timeline_.is_changing(); }
    /// Waits for the thread that builds.
    void wait() const;

private:
    struct Edit {
        std::function<compile::Plan()> make;
        std::function<void(const EditOutcome&)> told;
    };
    void build();
    void hand_over(std::unique_ptr<build::Generation> next, const Threads& threads);
    void retire(const Threads& threads);
    /// Every group has left the plan before and has completed a call since.
    bool is_before_left();
    void close_ended(const Threads& threads);

    const double seconds_;
    build::BuildContext& context_;
    Timeline& timeline_;
    Recorder& recorder_;
    std::optional<Edit> waiting_, making_;
    std::future<std::unique_ptr<build::Generation>> building_;
    std::vector<std::int64_t> settled_at_;  // what each group had done when nothing read the plan before any more
    std::int64_t changes_ = 0;
};

}  // namespace tactus::run
