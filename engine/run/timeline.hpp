// SPDX-License-Identifier: Apache-2.0
// The plans of a run in order of time, and the groups that run them.
#pragma once

#include "engine/build/generation.hpp"
#include "engine/run/options.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace tactus::run {

class Recorder;

/// Control thread.
class Timeline {
public:
    Timeline(const EngineOptions& options, build::BuildContext& context, Recorder& recorder)
        : options_(options), context_(context), recorder_(recorder) {}

    /// The plan that runs first. Throws Error.
    void begin(compile::Plan plan);
    /// Before an offline run: see Engine.
    void schedule(compile::Plan plan, Flicks when);
    void schedule_change(std::int64_t id, const std::string& node, const std::string& param, double value);

    /// Builds the next plan; on any thread, while the run goes on. Throws Error.
    std::unique_ptr<build::Generation> build_next(compile::Plan plan);
    /// Live: how far ahead the switch to a plan has to be, so that hands are without force by then.
    static Flicks lead_of(const build::Generation& next);
    /// From the first activation of a device of `period` that fades to when its hand is without force: a fade takes 10 ms,
    /// but one tick of a slow group at least.
    static Flicks fade_lead(Flicks period) { return std::max(flicks_per_second / 50, 2 * period); }
    /// Live: every group takes the plan over at `when`, but not before every hand that it reaches is without force.
    void hand_over(std::unique_ptr<build::Generation> next, Flicks when);
    /// Destroys the plan before; no group uses it any more.
    void retire();
    /// A plan is taking over: the one before still exists.
    bool is_changing() const { return before_ != nullptr; }

    /// The plan that runs, or ran last.
    const build::Generation& now() const { return *now_; }
    build::Generation& now() { return *now_; }
    /// Live, after `retire` and the end of the threads of groups that are over: forgets those groups but for what they counted.
    /// Those of one name and period count as one; of other names that are no more, the last `max_ended` have a row of their
    /// own. A run may be edited for days.
    void forget_ended();
    static constexpr std::size_t max_ended = 32;

    /// Every group that ever ran, the first plan's first; see `forget_ended`.
    const std::vector<std::shared_ptr<GroupRuntime>>& groups() const { return groups_; }
    /// Logical time that every group has reached, s.
    double progress_seconds() const;
    Report report() const;
    PortHashes port_hashes() const;

private:
    void add(const build::Generation& next, Flicks when);
    static void close_gate(build::Generation& next);
    void set_end(GroupRuntime& group) const;
    static void gather_hashes(const build::Generation& old, const build::Generation* next, PortHashes& parts);

    const EngineOptions& options_;
    build::BuildContext& context_;
    Recorder& recorder_;
    std::vector<std::shared_ptr<GroupRuntime>> groups_;
    std::unique_ptr<build::Generation> now_, before_;
    std::vector<std::unique_ptr<build::Generation>> scheduled_;  // offline: all that come before `now_`
    PortHashes ended_hashes_;
    ReplayedChanges replayed_changes_;
};

}  // namespace tactus::run
