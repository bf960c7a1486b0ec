// SPDX-License-Identifier: Apache-2.0
// When a live run pauses, in logical time: forces fade, then time stands still; afterwards forces come in anew.
#pragma once

#include "dsp/core/time.hpp"

#include <atomic>
#include <limits>

namespace tactus::run {

/// Written by the control thread, read by every group before each call. Wait-free.
struct PauseWindow {
    static_assert(std::atomic<Flicks>::is_always_lock_free);
    static constexpr Flicks never = std::numeric_limits<Flicks>::max();

    std::atomic<Flicks> fade{never};   ///< from here on forces are held off
    std::atomic<Flicks> stop{never};   ///< activations at or after this time wait
    std::atomic<Flicks> until{never};  ///< from here on forces are passed again

    bool holds_off(Flicks time) const noexcept {
        return time >= fade.load(std::memory_order_acquire) && time < until.load(std::memory_order_acquire);
    }
    bool stops(Flicks time) const noexcept { return time >= stop.load(std::memory_order_acquire); }
};

}  // namespace tactus::run
