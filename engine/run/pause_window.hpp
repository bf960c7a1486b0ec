// SPDX-License-Identifier: Apache-2.0
// When a live run pauses or ends, in logical time: forces fade, then time stands still; afterwards forces come in anew.
#pragma once

#include "dsp/core/time.hpp"

#include <atomic>
#include <limits>

namespace tactus::run {

/// Read by every group before each call. Wait-free.
struct PauseWindow {
    static_assert(std::atomic<Flicks>::is_always_lock_free);
    static constexpr Flicks never = std::numeric_limits<Flicks>::max();

    std::atomic<Flicks> fade{never};  ///< from here on forces are held off
    std::atomic<Flicks> stop{never};  ///< activations at or after this time wait
    std::atomic<Flicks> until{never};  ///< from here on forces are passed again
    std::atomic<Flicks> end{never};  ///< activations at or after this time do not run at all

    /// For a group of `period`: one that is so slow that it had no activation while forces were held off has one more.
    bool holds_off(Flicks time, Flicks period) const noexcept {
        if (time < fade.load(std::memory_order_acquire)) return false;
        const Flicks to = until.load(std::memory_order_acquire);
        return to == never || time < to + period;
    }
    bool stops(Flicks time) const noexcept { return time >= stop.load(std::memory_order_acquire); }
    bool ends(Flicks time) const noexcept { return time >= end.load(std::memory_order_acquire); }
};

}  // namespace tactus::run
