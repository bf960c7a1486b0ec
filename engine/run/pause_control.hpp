// SPDX-License-Identifier: Apache-2.0
// Pauses a live run and ends it: forces fade to zero and logical time stops, at the same time for all groups. After a
// pause both resume.
#pragma once

#include "engine/run/live_time.hpp"
#include "engine/run/timeline.hpp"

#include <atomic>

namespace tactus::run {

enum class Pausing : std::uint8_t { runs, fades, stands };

class PauseControl {
public:
    PauseControl(const Timeline& timeline, LiveTime& time) : timeline_(timeline), time_(time), present_(time) {}

    // Control thread.
    void want(bool wanted) { wanted_ = wanted; }
    Pausing state() const;
    /// Ends a pause that is no longer requested: sets the clock, and shifts `line` with it. Returns true at that
    /// moment.
    bool service(control::TrimmedClock& line);

    // Thread of the watchdog; wait-free.
    /// Begins a requested pause. Returns true at that moment: the caller must release the forces on all hands.
    bool begin_if_wanted() noexcept;
    /// Ends all groups at one logical time, as far as they have run. Returns true at the first call.
    bool end() noexcept;

private:
    const Timeline& timeline_;
    LiveTime& time_;
    Present present_;  // thread of the watchdog
    std::atomic<bool> wanted_{false};
};

}  // namespace tactus::run
