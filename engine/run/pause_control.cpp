// SPDX-License-Identifier: Apache-2.0
#include "engine/run/pause_control.hpp"

#include "engine/run/clock.hpp"

#include <algorithm>

namespace tactus::run {

namespace {

constexpr Flicks fade_time = flicks_per_second / 50;  // a fade takes 10 ms
constexpr Flicks lead = flicks_per_second / 20;

}  // namespace

Pausing PauseControl::state() const {
    const Flicks stop = window_.stop.load();
    if (stop == PauseWindow::never) return Pausing::runs;
    const bool all = std::ranges::all_of(timeline_.now().groups, [stop](const auto& group) {
        return group->is_over() || group->done() * group->plan->period >= stop;
    });
    return all ? Pausing::stands : Pausing::fades;
}

/// A pause begins a little ahead of the furthest group, so that all stop at one logical time; it ends with a clock that
/// was set to go on from there.
void PauseControl::service(control::TrimmedClock& line, RunClock& clock) {
    const Pausing now = state();
    if (now == Pausing::runs && wanted_) {
        const Flicks stop = timeline_.furthest() + lead;
        window_.fade = PauseWindow::never;
        window_.until = PauseWindow::never;
        window_.stop = stop;
        window_.fade = stop - fade_time;
    } else if (now == Pausing::stands && !wanted_) {
        const Flicks stop = window_.stop.load();
        line.steady_ns += steady_ns() + start_delay_ns - line.when(stop);
        clock.set(line);
        window_.until = stop + fade_time;
        window_.stop = PauseWindow::never;
    }
}

}  // namespace tactus::run
