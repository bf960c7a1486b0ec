// SPDX-License-Identifier: Apache-2.0
// A played device that notes when it was given which force, and whose driver may block.
#pragma once

#include "tests/engine/chaos.hpp"
#include "tests/engine/played_device.hpp"

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace tactus::test {

/// A hand that rests for `rest` and then presses `depth` deep. Made by `watched_hand`, which never destroys it: a thread
/// that is blocked in its driver may come back after the run.
struct WatchedHand {
    struct Given {
        std::int64_t ns = 0;  ///< steady clock
        double force_N = 0.0;
        std::thread::id by;
    };
    enum class Blocks { never, in_acquire, in_commit, in_commit_of_the_guard };

    double depth = 2e-3;  ///< m
    double rest = 0.1;  ///< s
    std::atomic<Blocks> blocks{Blocks::never};
    std::atomic<bool> is_blocked{false};
    std::atomic<std::int64_t> blocked_ns{0};  ///< since when
    std::atomic<bool> is_stale{false};  ///< its samples are not counted any more
    std::atomic<double> logical_s{0.0};  ///< time that its ticks have come to

    std::vector<Given> given() const;
    /// The force after the last commit, N.
    double force() const;
    /// The force at a time, N.
    double force_at(std::int64_t ns) const;
    /// From `ns` on, how long the force needed to be zero and stay so, ms; 1e9: it never did.
    double ms_to_zero(std::int64_t ns) const;
    /// The largest force after `ns`, N.
    double largest_after(std::int64_t ns) const;

    DeviceSample acquire(double elapsed_s);
    void commit(const Wrench& wrench);

    Performance performance;

private:
    void block();

    mutable std::mutex lock_;
    std::vector<Given> given_;
    std::atomic<std::thread::id> tick_;
    std::int64_t count_ = 0, counter_ = 0;
};

/// Makes the driver `name` open this hand.
WatchedHand& watched_hand(const std::string& name);

/// Adds a hand `name` on a spring of `stiffness`, which the node NAME_`spring` makes, and its device.
void add_hand(PatchText& patch, const std::string& name, const std::string& stiffness = "1 N/mm",
              const std::string& spring = "spring", const std::string& rate = "1 kHz");

std::int64_t steady_now();

}  // namespace tactus::test
