// SPDX-License-Identifier: Apache-2.0
// A run in real time: one thread per group on the steady clock, and a control thread that serves them. No thread waits
// for another.
#pragma once

#include "engine/run/live_edits.hpp"
#include "engine/run/pause_control.hpp"
#include "engine/run/run_clock.hpp"
#include "engine/run/watchdog.hpp"

#include <atomic>
#include <thread>
#include <utility>
#include <vector>

namespace tactus::run {

/// What a live run works with; all of it outlives the run.
struct LiveParts {
    io::EngineHost& host;
    Timeline& timeline;
    Recorder& recorder;
    LiveEdits& edits;
    PauseControl& pause;
};

/// Control thread.
class LiveRun {
public:
    LiveRun(const LiveParts& parts, const LiveOptions& options) : parts_(parts), options_(options) {}

    /// Runs to the end. Throws Error.
    void run();

private:
    void start_threads();
    void start_thread(GroupRuntime& group);
    void end_thread(const GroupRuntime& group);
    /// Thread of the group.
    void work(GroupRuntime& group);
    void rest_while_paused(GroupRuntime& group, control::TrimmedClock& line);
    bool pauses(const GroupRuntime& group) const;

    void service();
    void service_cards();
    void service_pause();
    void watch_devices();
    /// Ends all groups at one logical time when that is asked for, once.
    void service_stop();
    void complete();

    LiveParts parts_;
    const LiveOptions& options_;
    control::TrimmedClock line_;  // control thread
    RunClock clock_;
    Watchdog watchdog_;
    std::atomic<bool> started_{false};      // not before every thread is there, whatever making them takes
    std::atomic<std::size_t> ready_{0};     // threads that wait for the start
    std::atomic<std::size_t> running_{0};   // threads that have not ended
    std::atomic<bool> is_refused_{false};   // real-time priority
    bool is_still_ = false;                 // time stands still, or has just begun to go on
    bool is_stopping_ = false;
    bool must_end_ = false;  // a device is lost
    std::vector<std::pair<const GroupRuntime*, std::jthread>> threads_;
};

}  // namespace tactus::run
