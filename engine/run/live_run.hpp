// SPDX-License-Identifier: Apache-2.0
// A run in real time: one thread per group on the steady clock, one per device that guards it, one that acts at once when
// the run is to pause or to end, and a control thread that serves them. No thread waits for another.
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

/// What a live run works with; all of it outlives the run.
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
    /// After `run`: threads were left behind in drivers. Neither this nor its parts may ever be destroyed.
    bool has_left_threads() const { return has_left_threads_; }

private:
    struct GroupThread {
        GroupThread(GroupRuntime& group_, int priority_) : group(group_), priority(priority_) {}

        enum Order : int { wait, go, cancel };
        GroupRuntime& group;
        std::atomic<int> order{wait};
        std::atomic<bool> is_over{false};
        std::atomic<std::int64_t> busy_since_ns{0};  ///< when its present call began; 0: it is between two
        std::thread thread;
        int priority;  ///< control thread
        // Control thread: since when it should have ended, and how far it had come then.
        std::int64_t late_since_ns = 0, done = 0;
    };

    // group_thread.cpp
    void start_threads();
    /// Makes a thread that waits for its order. Throws std::system_error when the system refuses it.
    void make_thread(GroupRuntime& group, int priority);
    /// Of the groups that run: an edit may have changed what they are there for.
    void set_priorities(const build::Generation& generation);
    /// Ends those that still wait.
    void cancel_threads();
    void release_threads();
    void end_thread(const GroupRuntime& group);
    /// Thread of the group.
    void work(GroupThread& mine);
    void rest_while_paused(GroupRuntime& group, control::TrimmedClock& line);
    bool pauses(const GroupRuntime& group) const;
    bool is_over(const GroupRuntime& group) const;
    void prepare_threads(const build::Generation& next);
    void guard(const std::vector<std::unique_ptr<build::DeviceSlot>>& devices);

    /// Thread of the watchdog: a stop and a pause act from here, whatever the control thread is at.
    void look() noexcept;
    void service();
    void service_cards();
    void service_pause();
    /// A notice, once per group, when values of the world are late by three periods.
    void note_old_values();
    /// The groups that are no more, all at once.
    bool all_over() const;
    /// After its end: threads that a driver keeps are left behind.
    void leave_blocked();
    void end_all();
    void complete();

    LiveParts parts_;
    const LiveOptions options_;
    control::TrimmedClock line_;  // control thread
    Present present_;
    PriorityWatch priorities_;
    Watchdog watchdog_;
    std::size_t devices_in_use_ = 0;  // of those that the watchdog looks after
    std::atomic<std::size_t> ready_{0};  // threads that wait for the start
    std::atomic<bool> is_refused_{false};  // real-time priority
    std::atomic<bool> must_end_{false};  // an error, or a lost device, ended the run
    bool is_still_ = false;  // time stands still, or has just begun to go on
    bool has_left_threads_ = false;
    std::vector<std::unique_ptr<GroupThread>> threads_;
    std::set<std::string> noted_sources_;  // whose late values were reported
    std::set<std::string> noted_demotions_;
};

}  // namespace tactus::run
