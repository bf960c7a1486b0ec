// SPDX-License-Identifier: Apache-2.0
// The plans of a run in order of time, and the groups that execute them.
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

    /// Sets the first plan. Throws Error.
    void begin(compile::Schedule plan);
    /// Before an offline run: see Engine.
    void schedule(compile::Schedule plan, Flicks when);
    void schedule_change(std::int64_t id, const std::string& node, const std::string& param, double value);

    /// Builds the next plan, on any thread, during the run. Throws Error.
    std::unique_ptr<build::Generation> build_next(compile::Schedule plan);
    /// Live: lead time of a switch, so that hands are without force by then.
    static Flicks lead_of(const build::Generation& next);
    /// Time from the first fading activation of a device of `period` until its hand is without force: a fade lasts 10
    /// ms, but at least one tick of a slow group.
    static Flicks fade_lead(Flicks period) { return std::max(flicks_per_second / 50, 2 * period); }
    /// Live: every group switches to the plan at `when`, but not before all hands that it reaches are without force.
    void hand_over(std::unique_ptr<build::Generation> next, Flicks when);
    /// Destroys the previous plan, which no group may use any more.
    void retire();
    /// True while a plan is taking over and the previous one still exists.
    bool is_changing() const { return before_ != nullptr; }

    /// The running plan, or the last one.
    const build::Generation& now() const { return *now_; }
    build::Generation& now() { return *now_; }
    /// Live, after `retire` and the end of the threads of ended groups: frees those groups except for their counts.
    /// Groups of equal name and period are merged; of names that no longer run, the last `max_ended` keep separate
    /// rows. This bounds memory in runs that are edited for days.
    void forget_ended();
    static constexpr std::size_t max_ended = 32;

    /// Every group that ever ran, those of the first plan first; see `forget_ended`.
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
    std::vector<std::unique_ptr<build::Generation>> scheduled_;  // offline: all plans before `now_`
    PortHashes ended_hashes_;
    ReplayedChanges replayed_changes_;
};

}  // namespace tactus::run
