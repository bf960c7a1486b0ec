// SPDX-License-Identifier: Apache-2.0
// Runs a plan: on a virtual clock as fast as possible, or in real time. Both produce the same output bits. A running
// plan can be edited: the new plan takes over at one logical time, and nodes that the edit does not change survive.
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

    /// Takes ownership of the plan, prepares every node and connects the wires. Assets must be loaded. Throws Error.
    Engine(compile::Schedule plan, const EngineOptions& options);
    ~Engine();
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    /// Before an offline run: schedules a plan for logical time `when`, or for the time in the replayed log. Times must
    /// increase. Throws Error.
    void schedule(compile::Schedule plan, Flicks when);
    /// Before an offline run: schedules a parameter change by its number in the replayed log, in the plan scheduled
    /// last.
    void schedule_change(std::int64_t id, const std::string& node, const std::string& param, double value);

    /// Runs to the end on `threads` threads. `progress` receives the completed fraction; an exception from it ends the
    /// run. Throws Error.
    void render(int threads, const std::function<void(double)>& progress = {});
    /// Instead of `render`, for a program with its own loop: runs every activation before logical time `until` on the
    /// calling thread. Call it any number of times with growing `until`. Produces the same bits as `render`, however
    /// time is divided. Does not allocate, lock or wait as long as nothing is recorded and no observer watches every
    /// value. Parameters may be `set` between calls. Throws Error when the run cannot continue.
    void advance(Flicks until);
    /// After the last `advance`: ends the run. Then call `complete`.
    void end_advance() { parts_->offline.complete(); }
    /// Runs in real time, one thread per group. If the disk is full, the affected recording ends and the run continues.
    /// Throws Error. An engine runs only once.
    void run_live(const LiveOptions& options);

    /// During a live run, from `watch`: `make` compiles a plan on another thread, which then takes over. `told`
    /// receives the outcome on the control thread. Edits run one after another; only the newest pending edit is kept.
    void edit(std::function<compile::Schedule()> make, std::function<void(const EditOutcome&)> told);
    /// During a live run, from `watch`, or between two `advance`: sets a parameter, "0.8 N/mm", 3 ms ahead. A parameter
    /// on which a force depends ramps from then on (param_ramps.hpp). Returns the logical time. Throws Error on unknown
    /// names, structural or driven parameters, and values out of range.
    Flicks set(const std::string& node, const std::string& param, const std::string& text);
    /// During a live run, from `watch`: true fades forces to zero immediately and stops logical time; false continues,
    /// and forces ramp in again. A take reproduces the pause bit by bit.
    void pause(bool wanted) { parts_->pause.want(wanted); }
    /// During a live run with a take, from `watch`: starts or stops recording every value, at a time slightly ahead
    /// that is the same for all groups. Timing decisions are recorded from the beginning, so that the take can repeat
    /// the run up to that time. No tick is disturbed. Throws Error if the take was abandoned.
    void record(bool wanted);
    bool is_recording() const { return parts_->recorder.is_recording(); }
    /// True if values were recorded in the take.
    bool was_recorded() const { return parts_->recorder.was_recorded(); }
    Pausing pausing() const { return parts_->pause.state(); }
    /// True if no edit is in progress.
    bool is_settled() const { return parts_->edits.is_settled(); }

    /// During a render, any thread: ends the run soon, as if a shorter time had been requested.
    void stop();

    /// Completes recordings; files that could not be completed are listed in `losses`.
    void complete();
    /// As `complete`, but throws Error if there are losses.
    void finish();
    /// Recordings cut short by a full disk, with the reason; also among the notices. Control thread.
    const std::vector<std::string>& losses() const { return parts_->losses.list(); }

    /// Results that the nodes report. After the run.
    Report report() const;
    /// Hash over every published value of every output, joined in name order. After the run.
    std::uint64_t output_hash() const;
    /// The same, per output ("node.port").
    PortHashes port_hashes() const;

    /// The running plan, or the last one.
    const compile::Schedule& plan() const { return parts_->timeline.now().plan; }
    /// Every group that ever ran, those of the first plan first.
    const std::vector<std::shared_ptr<GroupRuntime>>& groups() const { return parts_->timeline.groups(); }
    /// The nodes of the running plan. Control thread.
    const std::vector<std::shared_ptr<build::LiveNode>>& nodes() const { return parts_->timeline.now().nodes; }
    const io::EngineHost& host() const { return parts_->host; }
    std::uint64_t plan_hash() const { return plan_hash_; }
    std::int64_t edits() const { return parts_->timeline.now().number; }
    /// Logical time that every group has reached, s.
    double progress_seconds() const;

private:
    /// Everything that threads of the run refer to. It is never freed if a driver does not return a thread.
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
