// SPDX-License-Identifier: Apache-2.0
// Logical time during a run, including pauses.
#pragma once

#include "dsp/core/clock.hpp"
#include "engine/run/pause_window.hpp"
#include "engine/run/run_clock.hpp"

#include <algorithm>

namespace tactus::run {

struct LiveTime {
    RunClock clock;
    PauseWindow window;
    Flicks advanced = -1;  ///< time reached by a run that its caller advances; −1: a live run, whose clock defines it
};

/// One thread's view of the logical time.
class Present {
public:
    explicit Present(const LiveTime& time) : time_(time) {}

    /// Returns the current logical time: no group has begun a later activation. 0 before the run. Wait-free.
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
