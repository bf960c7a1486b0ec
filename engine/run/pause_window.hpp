// SPDX-License-Identifier: Apache-2.0
// The logical times of a pause or end of a live run: forces fade, then time stops; afterwards forces ramp in again.
#pragma once

#include "dsp/core/time.hpp"

#include <atomic>
#include <limits>

namespace tactus::run {

/// Read by every group before each call. Wait-free.
struct PauseWindow {
    static_assert(std::atomic<Flicks>::is_always_lock_free);
    static constexpr Flicks never = std::numeric_limits<Flicks>::max();

    std::atomic<Flicks> fade{never};  ///< forces are suspended from this time on
    std::atomic<Flicks> stop{never};  ///< activations at or after this time wait
    std::atomic<Flicks> until{never};  ///< forces resume at this time
    std::atomic<Flicks> end{never};  ///< activations at or after this time never run

    // The same without a pause, while a parameter changes that cannot ramp; only the control thread sets them:
    std::atomic<Flicks> set_fade{never}, set_until{never};

    /// For a group of `period`. A group so slow that it had no activation during the suspension has one more suspended.
    bool holds_off(Flicks time, Flicks period) const noexcept {
        return is_within(fade, until, time, period) || is_within(set_fade, set_until, time, period);
    }
    bool stops(Flicks time) const noexcept { return time >= stop.load(std::memory_order_acquire); }
    bool ends(Flicks time) const noexcept { return time >= end.load(std::memory_order_acquire); }

private:
    static bool is_within(const std::atomic<Flicks>& from, const std::atomic<Flicks>& to, Flicks time,
                          Flicks period) noexcept {
        if (time < from.load(std::memory_order_acquire)) return false;
        const Flicks end = to.load(std::memory_order_acquire);
        return end == never || time < end + period;
    }
};

}  // namespace tactus::run
