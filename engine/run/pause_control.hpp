// SPDX-License-Identifier: Apache-2.0
// Pauses a live run and ends it: forces fade to zero and logical time stops, the same for all groups; later both go on.
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
    /// Ends a pause that is no longer wanted: sets the clock, and moves `line` with it. True at that moment.
    bool service(control::TrimmedClock& line);

    // Thread of the watchdog; wait-free.
    /// Begins a pause that is wanted. True at that moment: forces on all hands are to be let go of.
    bool begin_if_wanted() noexcept;
    /// All groups end, at one logical time as far as they run. True at the first call.
    bool end() noexcept;

private:
    const Timeline& timeline_;
    LiveTime& time_;
    Present present_;  // thread of the watchdog
    std::atomic<bool> wanted_{false};
};

}  // namespace tactus::run
