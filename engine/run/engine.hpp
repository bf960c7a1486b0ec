// SPDX-License-Identifier: Apache-2.0
// Runs a plan: on a virtual clock as fast as possible, or in real time. Both give the same output bits. A running plan
// can be edited: the new plan takes over at one logical time, and nodes that the edit does not touch go on.
#pragma once

#include "engine/run/live_edits.hpp"
#include "engine/run/offline_run.hpp"
#include "engine/run/options.hpp"
#include "engine/run/pause_control.hpp"
#include "engine/run/recorder.hpp"
#include "engine/run/timeline.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tactus::run {

class Engine {
public:
    using PortHashes = run::PortHashes;
    using Pausing = run::Pausing;

    /// Takes the plan, prepares every node and lays out the wires. Assets must be loaded. Throws Error.
    Engine(compile::Plan plan, const EngineOptions& options);
    ~Engine();
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    /// Before an offline run: from logical time `when` on, or where the replayed log says, this plan runs. Later ones
    /// have later times. Throws Error.
    void schedule(compile::Plan plan, Flicks when);
    /// Before an offline run: parameter changes by their number in the replayed log, in the plan scheduled last.
    void schedule_change(std::int64_t id, const std::string& node, const std::string& param, double value);

    /// Runs to the end on `threads` threads; `progress` is told the fraction done; what it throws ends the run. Throws
    /// Error.
    void render(int threads, const std::function<void(double)>& progress = {});
    /// Instead of `render`, any number of times with growing `until`: runs every activation before that logical time on
    /// the calling thread, for a program that drives the patch from a loop of its own. The same bits as `render`, however
    /// time is divided. Allocates, locks and waits for nothing while nothing is recorded and no observer watches every
    /// value. Parameters may be `set` in between. Throws Error when the run cannot go on.
    void advance(Flicks until);
    /// After the last `advance`: the run ends there. Then `complete`.
    void end_advance() { parts_->offline.complete(); }
    /// Runs in real time, one thread per group. An output that the disk has no room for ends, the run goes on. Throws
    /// Error. Engines run once.
    void run_live(const LiveOptions& options);

    /// While a live run goes on, from `watch`: `make` compiles a plan on another thread, which then takes over. `told`
    /// hears of the outcome from the control thread. Edits wait for each other; of those that wait the last one counts.
    void edit(std::function<compile::Plan()> make, std::function<void(const EditOutcome&)> told);
    /// While a live run goes on, from `watch`, or between two `advance`: sets a parameter, "0.8 N/mm", 3 ms ahead. One on
    /// which a force depends ramps from there (param_ramps.hpp). Returns the logical time. Throws Error on unknown names,
    /// on structural or driven parameters, and on values out of range.
    Flicks set(const std::string& node, const std::string& param, const std::string& text);
    /// While a live run goes on, from `watch`: forces fade to zero at once and logical time stops, or it goes on and forces
    /// come in anew. A take repeats it to the bit.
    void pause(bool wanted) { parts_->pause.want(wanted); }
    /// While a live run with a take goes on, from `watch`: from a moment a little ahead on, the same for all groups,
    /// the take holds every value, or no more. What timing decided it holds from the beginning, so it repeats the run
    /// up to there. No tick is disturbed. Throws Error when the take was given up.
    void record(bool wanted);
    bool is_recording() const { return parts_->recorder.is_recording(); }
    /// Some values are in the take.
    bool was_recorded() const { return parts_->recorder.was_recorded(); }
    Pausing pausing() const { return parts_->pause.state(); }
    /// No edit is in progress.
    bool is_settled() const { return parts_->edits.is_settled(); }

    /// During a render, any thread: ends it soon, as if less time had been asked for.
    void stop();

    /// Completes recordings; what could not be written to its end is among the `losses`.
    void complete();
    /// The same; throws Error when there are losses.
    void finish();
    /// What the disk had no room for, and why; among the notices, too. Control thread.
    const std::vector<std::string>& losses() const { return parts_->losses.list(); }

    /// What the nodes report. After the run.
    Report report() const;
    /// Hash over every published value of every output, joined in name order. After the run.
    std::uint64_t output_hash() const;
    /// The same, per output ("node.port").
    PortHashes port_hashes() const;

    /// The plan that runs, or ran last.
    const compile::Plan& plan() const { return parts_->timeline.now().plan; }
    /// Every group that ever ran, the first plan's first.
    const std::vector<std::shared_ptr<GroupRuntime>>& groups() const { return parts_->timeline.groups(); }
    /// Those of the plan that runs. Control thread.
    const std::vector<std::shared_ptr<build::LiveNode>>& nodes() const { return parts_->timeline.now().nodes; }
    const io::EngineHost& host() const { return parts_->host; }
    std::uint64_t plan_hash() const { return plan_hash_; }
    std::int64_t edits() const { return parts_->timeline.now().number; }
    /// Logical time that every group has reached, s.
    double progress_seconds() const;

private:
    /// Everything that threads of the run refer to. It is kept for ever when a driver never returns a thread.
    struct Parts {
        explicit Parts(const EngineOptions& options_);

        EngineOptions options;
        io::EngineHost host;
        Losses losses;
        Recorder recorder;
        build::BuildContext context;
        Timeline timeline;
        LiveTime time;
        LiveEdits edits;
        PauseControl pause;
        OfflineRun offline;
    };

    std::uint64_t plan_hash_ = 0;
    std::shared_ptr<Parts> parts_;
};

}  // namespace tactus::run
