// SPDX-License-Identifier: Apache-2.0
// Watchdog of a device: another thread takes over the output when the tick's thread stops committing forces.
#pragma once

#include "dsp/control/force_bounds.hpp"
#include "dsp/core/types.hpp"

#include <atomic>
#include <cstdint>

namespace tactus::control {

/// Ownership of a device's output between its tick's thread and a watchdog thread. Times are nanoseconds of one steady
/// clock, given by the callers. A device that hangs inside a commit cannot be taken over: its driver is not re-entrant,
/// and no other thread could reach the motors through it.
class CommitGuard {
    enum Owner : int { idle, committing, taken };
    static_assert(std::atomic<int>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free);

public:
    std::int64_t limit_ns = 3'000'000;  ///< age of the last commit at which the tick's thread counts as lost
    std::int64_t fade_ns = 10'000'000;  ///< duration of the fade to zero after taking over

    /// Before a commit. False when the watchdog holds the device: commit nothing, latch a fault. Tick thread;
    /// wait-free.
    bool begin() noexcept {
        int expected = idle;
        return owner_.compare_exchange_strong(expected, committing, std::memory_order_acquire);
    }
    /// After a commit of `wrench`. Tick thread; wait-free.
    void end(const Wrench& wrench, std::int64_t now_ns) noexcept {
        last_ = wrench;
        committed_ns_.store(now_ns, std::memory_order_relaxed);
        owner_.store(idle, std::memory_order_release);
    }

    /// True when the caller must commit `out`: the last force, fading to zero. False before the first commit. `at_once`
    /// skips the wait for the limit: no commit will come. Watchdog thread; wait-free.
    bool poll(std::int64_t now_ns, Wrench& out, bool at_once = false) noexcept {
        if (owner_.load(std::memory_order_acquire) != taken) {
            const std::int64_t committed = committed_ns_.load(std::memory_order_relaxed);
            if (committed == never || (!at_once && now_ns - committed <= limit_ns)) return false;
            int expected = idle;
            if (!owner_.compare_exchange_strong(expected, taken, std::memory_order_acq_rel)) return false;
            // A commit may have finished between the two loads; then the device is given back at once.
            if (!at_once && now_ns - committed_ns_.load(std::memory_order_relaxed) <= limit_ns) {
                owner_.store(idle, std::memory_order_release);
                return false;
            }
            taken_ns_ = now_ns;
        }
        out = last_ * fade_left(static_cast<double>(now_ns - taken_ns_), static_cast<double>(fade_ns));
        return true;
    }
    /// Returns the device to the tick's thread. Watchdog thread, on request of the user; wait-free.
    void release() noexcept {
        committed_ns_.store(never, std::memory_order_relaxed);
        owner_.store(idle, std::memory_order_release);
    }

    /// The watchdog has the device and `poll` has reached zero force by that time. Watchdog thread; wait-free.
    bool has_faded(std::int64_t now_ns) const noexcept { return is_taken() && now_ns - taken_ns_ >= fade_ns; }
    /// A commit has finished since the start or the last release. Any thread; wait-free.
    bool has_committed() const noexcept { return committed_ns_.load(std::memory_order_relaxed) != never; }

    /// Any thread; wait-free.
    bool is_taken() const noexcept { return owner_.load(std::memory_order_acquire) == taken; }

private:
    static constexpr std::int64_t never = INT64_MIN;

    std::atomic<int> owner_{idle};
    std::atomic<std::int64_t> committed_ns_{never};
    std::int64_t taken_ns_ = 0;  // watchdog thread only
    Wrench last_;  // accessed by the present owner
};

}  // namespace tactus::control
