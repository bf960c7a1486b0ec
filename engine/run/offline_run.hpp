// SPDX-License-Identifier: Apache-2.0
// A run on the virtual clock: groups run as soon as what they read is there, and wait for each other.
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
    /// Any thread: ends the run soon.
    void stop();

private:
    void work(const std::vector<GroupRuntime*>& mine, std::uint64_t seed);
    /// The group of `mine` that is to run next; null: none is ready. `all_finished`: none will ever be.
    GroupRuntime* earliest_ready(const std::vector<GroupRuntime*>& mine, bool& all_finished);
    void wake_others();
    /// Waits until something has changed since `steps_` was `seen`. Throws Error when nothing ever will, as with a log
    /// that does not fit the patch.
    void await_step(std::uint32_t seen);
    std::string why_it_stands() const;
    void complete();
    void fail(std::exception_ptr error);

    const EngineOptions& options_;
    Timeline& timeline_;
    Recorder& recorder_;
    std::atomic<std::uint32_t> steps_{0};  // rises when something has become readable
    std::atomic<bool> stop_{false};
    std::mutex idle_lock_;  // of the three below
    std::size_t working_ = 0;  // threads that have groups left
    std::size_t idle_ = 0;  // of these, those that found no group ready while `steps_` was `idle_step_`
    std::uint32_t idle_step_ = 0;
    std::mutex failure_lock_;
    std::exception_ptr failure_;  // the first one
};

}  // namespace tactus::run
