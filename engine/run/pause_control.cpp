// SPDX-License-Identifier: Apache-2.0
#include "engine/run/pause_control.hpp"

#include <algorithm>

namespace tactus::run {

namespace {

constexpr Flicks fade_time = flicks_per_second / 50;  // a fade takes 10 ms
// Delay from the request to the first fading tick and to the first omitted tick; all groups must see it in time.
constexpr Flicks pause_lead = flicks_per_second / 1000;
constexpr Flicks stop_lead = flicks_per_second * 30 / 1000;

}  // namespace

Pausing PauseControl::state() const {
    const Flicks stop = time_.window.stop.load();
    if (stop == PauseWindow::never) return Pausing::runs;
    const bool all = std::ranges::all_of(timeline_.now().groups, [stop](const auto& group) {
        return group->is_over() || group->done() * group->plan->period >= stop;
    });
    return all ? Pausing::stands : Pausing::fades;
}

/// Restarts the clock at the logical time of the pause.
bool PauseControl::service(control::TrimmedClock& line) {
    PauseWindow& window = time_.window;
    if (wanted_ || window.end != PauseWindow::never || state() != Pausing::stands) return false;
    const Flicks stop = window.stop.load();
    line.steady_ns += steady_ns() + start_delay_ns - line.when(stop);
    time_.clock.set(line);
    window.until = stop + fade_time;
    window.stop = PauseWindow::never;
    return true;
}

bool PauseControl::begin_if_wanted() noexcept {
    PauseWindow& window = time_.window;
    // Check in this order: `wanted_` is false if a pause has just ended.
    if (window.stop != PauseWindow::never || window.end != PauseWindow::never || !wanted_) return false;
    const Flicks now = present_.now();
    window.fade = PauseWindow::never;
    window.until = PauseWindow::never;
    window.stop = now + stop_lead;
    window.fade = now + pause_lead;
    return true;
}

bool PauseControl::end() noexcept {
    PauseWindow& window = time_.window;
    if (window.end != PauseWindow::never) return false;
    const Flicks now = present_.now();
    // During a pause no group advances beyond its start.
    window.end = std::min(now + stop_lead, window.stop.load());
    // A pause includes a fade; forces that re-engage after it are suspended again.
    window.until = PauseWindow::never;
    if (window.stop == PauseWindow::never) window.fade = now + pause_lead;
    return true;
}

}  // namespace tactus::run
