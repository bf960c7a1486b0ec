// SPDX-License-Identifier: Apache-2.0
// A run in real time: one thread per group on the steady clock, one guarding thread per device, one that immediately
// pauses or ends the run on request, and a control thread that serves them. No thread waits for another.
#pragma once

#include "engine/run/live_edits.hpp"
#include "engine/run/live_time.hpp"
#include "engine/run/pause_control.hpp"
#include "engine/run/priority_watch.hpp"
#include "engine/run/watchdog.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace tactus::run {

/// The components of a live run; all of them outlive the run.
struct LiveParts {
    io::EngineHost& host;
    Timeline& timeline;
    Recorder& recorder;
    LiveEdits& edits;
    LiveTime& time;
    PauseControl& pause;
};

/// Control thread.
class LiveRun {
public:
    LiveRun(const LiveParts& parts, const LiveOptions& options);
    ~LiveRun();
    LiveRun(const LiveRun&) = delete;
    LiveRun& operator=(const LiveRun&) = delete;

    /// Runs to the end. Throws Error, std::system_error.
    void run();
    /// After `run`: true if threads were abandoned in drivers. Neither this object nor its parts may ever be destroyed
    /// then.
    bool has_left_threads() const { return has_left_threads_; }

private:
    struct GroupThread {
        GroupThread(GroupRuntime& group_, int priority_) : group(group_), priority(priority_) {}

        enum Order : int { wait, go, cancel };
        GroupRuntime& group;
        std::atomic<int> order{wait};
        std::atomic<bool> is_over{false};
        std::atomic<std::int64_t> busy_since_ns{0};  ///< start of its current call; 0: between two calls
        std::thread thread;
        int priority;  ///< control thread
        // Control thread: the time since which it should have ended, and its progress then.
        std::int64_t late_since_ns = 0, done = 0;
    };

    // group_thread.cpp
    void start_threads();
    /// Creates a thread that waits for its start. Throws std::system_error when the system refuses it.
    void make_thread(GroupRuntime& group, int priority);
    /// Sets the priorities of running groups, whose criticality an edit may have changed.
    void set_priorities(const build::Generation& generation);
    /// Ends the threads that still wait for their start.
    void cancel_threads();
    void release_threads();
    void end_thread(const GroupRuntime& group);
    /// Thread of the group.
    void work(GroupThread& mine);
    void rest_while_paused(GroupRuntime& group, control::TrimmedClock& line);
    bool pauses(const GroupRuntime& group) const;
    bool is_over(const GroupRuntime& group) const;
    void prepare_threads(const build::Generation& next);
    void guard(const std::vector<std::unique_ptr<io::DeviceSlot>>& devices);

    /// Thread of the watchdog: a stop and a pause are started from here, even if the control thread is busy.
    void look() noexcept;
    void service();
    void service_cards();
    void service_pause();
    /// Adds a notice, once per group, when its world values are late by three periods.
    void note_old_values();
    /// True if all groups have ended.
    bool all_over() const;
    /// After the end: abandons threads that a driver blocks.
    void leave_blocked();
    void end_all();
    void complete();

    LiveParts parts_;
    const LiveOptions options_;
    control::TrimmedClock line_;  // control thread
    Present present_;
    PriorityWatch priorities_;
    Watchdog watchdog_;
    std::size_t devices_in_use_ = 0;  // number of devices under the watchdog
    std::atomic<std::size_t> ready_{0};  // threads that wait for the start
    std::atomic<bool> is_refused_{false};  // the system refused real-time priority
    std::atomic<bool> must_end_{false};  // an error, or a lost device, ended the run
    bool is_still_ = false;  // time is paused, or has just been resumed
    bool has_left_threads_ = false;
    std::vector<std::unique_ptr<GroupThread>> threads_;
    std::set<std::string> noted_sources_;  // sources whose late values were reported
    std::set<std::string> noted_demotions_;
};

}  // namespace tactus::run
