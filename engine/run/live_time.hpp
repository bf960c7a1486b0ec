// SPDX-License-Identifier: Apache-2.0
// Logical time of a run while it goes on, and when it stands still.
#pragma once

#include "dsp/core/clock.hpp"
#include "engine/run/pause_window.hpp"
#include "engine/run/run_clock.hpp"

#include <algorithm>

namespace tactus::run {

struct LiveTime {
    RunClock clock;
    PauseWindow window;
    Flicks advanced = -1;  ///< of a run that its caller advances: how far; −1: the clock of a live run says it
};

/// What one thread knows of it.
class Present {
public:
    explicit Present(const LiveTime& time) : time_(time) {}

    /// Logical time now: no group has begun an activation after it. 0 before the run. Wait-free.
    Flicks now() noexcept {
        if (time_.advanced >= 0) return time_.advanced;
        has_line_ = time_.clock.try_get(line_) || has_line_;
        if (!has_line_) return 0;
        const Flicks stop = time_.window.stop.load(std::memory_order_acquire);
        return std::clamp<Flicks>(line_.at(steady_ns()), 0, stop);
    }

private:
    const LiveTime& time_;
    control::TrimmedClock line_;
    bool has_line_ = false;
};

}  // namespace tactus::run
