// SPDX-License-Identifier: Apache-2.0
// Pauses a live run: forces fade to zero and logical time stops, the same for all groups; later both go on.
#pragma once

#include "engine/run/pause_window.hpp"
#include "engine/run/run_clock.hpp"
#include "engine/run/timeline.hpp"

namespace tactus::run {

enum class Pausing : std::uint8_t { runs, fades, stands };

/// Control thread.
class PauseControl {
public:
    explicit PauseControl(const Timeline& timeline) : timeline_(timeline) {}

    void want(bool wanted) { wanted_ = wanted; }
    Pausing state() const;
    /// What groups look at before each call.
    const PauseWindow& window() const { return window_; }
    /// Begins or ends a pause. A pause that ends sets the clock, and moves `line` with it.
    void service(control::TrimmedClock& line, RunClock& clock);

private:
    const Timeline& timeline_;
    PauseWindow window_;
    bool wanted_ = false;
};

}  // namespace tactus::run
