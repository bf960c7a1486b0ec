// SPDX-License-Identifier: Apache-2.0
// A run on the virtual clock: groups run as soon as their inputs are available, and wait for each other.
#pragma once

#include "engine/run/recorder.hpp"
#include "engine/run/timeline.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace tactus::run {

class OfflineRun {
public:
    OfflineRun(const EngineOptions& options, Timeline& timeline, Recorder& recorder)
        : options_(options), timeline_(timeline), recorder_(recorder) {}

    /// Runs to the end on `threads` threads; see Engine::render.
    void run(int threads, const std::function<void(double)>& progress);
    /// Runs every activation before `until` on the calling thread; see Engine::advance.
    void advance(Flicks until);
    /// Ends the run: groups end at their current activation, and their outputs are written.
    void complete();
    /// Any thread: ends the run soon.
    void stop();

private:
    void work(const std::vector<GroupRuntime*>& mine, std::uint64_t seed);
    /// Returns the next group of `mine` to run; null if none is ready. `all_finished`: none has an activation before
    /// `until`.
    GroupRuntime* earliest_ready(const std::vector<GroupRuntime*>& mine, Flicks until, bool& all_finished);
    /// Begins or ends a call of at most `frames` activations.
    void step(GroupRuntime& group, int frames);
    void wake_others();
    /// Waits until `steps_` differs from `seen`. Throws Error if no progress is possible, as with a log that does not
    /// match the patch.
    void await_step(std::uint32_t seen);
    std::string why_it_stands() const;
    void fail(std::exception_ptr error);

    const EngineOptions& options_;
    Timeline& timeline_;
    Recorder& recorder_;
    std::atomic<std::uint32_t> steps_{0};  // increases when new values are readable
    std::atomic<bool> stop_{false};
    std::mutex idle_lock_;  // for the three below
    std::size_t working_ = 0;  // threads with unfinished groups
    std::size_t idle_ = 0;  // of these, threads that found no ready group while `steps_` was `idle_step_`
    std::uint32_t idle_step_ = 0;
    std::vector<GroupRuntime*> advanced_;  // all groups, of `advance`
    std::mutex failure_lock_;
    std::exception_ptr failure_;  // the first one
};

}  // namespace tactus::run
