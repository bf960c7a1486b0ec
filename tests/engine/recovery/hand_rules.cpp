// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/recovery/hand_rules.hpp"

#include "dsp/control/force_limiter.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::test {

namespace {

constexpr double rounding = 1e-9;
constexpr std::int64_t stale_ticks = 10, engage_ticks = 3;
constexpr std::int64_t attended = 10'002;  // ms; times are sums of ticks
constexpr double small = 0.5;  // N
constexpr std::size_t max_left_out = 10;

}  // namespace

void HandRules::take_over(const HandLimits& limits) {
    limits_ = limits;
    counter_ = -1;
    must_engage_ = true;
    was_engaged_ = false;
    small_ticks_ = ramped_ = 0;
    is_let_ = false;
}

void HandRules::note_lateness(const TickSeen& seen) {
    for (std::int64_t n = 0; n < seen.left_out; ++n) left_out_.push_back(seen.logical);
    while (!left_out_.empty() && left_out_.front() <= seen.logical - on_time) left_out_.pop_front();
    const bool is_late = seen.sample.taken || seen.sample.late;
    if (is_late || seen.left_out > 2 || left_out_.size() > max_left_out) {
        last_late_ = seen.logical;
        left_out_.clear();
    }
    if (!is_late || is_late_) return;
    is_late_ = true;
    is_let_ = false;
    needs_person_ = needs_person_ || static_cast<std::size_t>(std::ranges::count_if(returns_, [&](std::int64_t at) {
                                         return seen.logical - at < window;
                                     })) >= max_returns;
}

void HandRules::note_device(const TickSeen& seen) {
    repeats_ = seen.sample.counter == counter_ ? repeats_ + 1 : 0;
    counter_ = seen.sample.counter;
    if (seen.sample.valid && repeats_ < stale_ticks && !seen.sample.sound_lost) return;
    is_bad_ = true;
    last_bad_ = seen.logical;
}

void HandRules::note_loss(const TickSeen& seen) {
    const bool was_away = has_lost(), was_held = is_held_;
    note_lateness(seen);
    note_device(seen);
    is_nan_ = is_nan_ || !std::isfinite(seen.asked);
    is_held_ = seen.is_held_off;
    if (has_lost() && !was_away) {
        zero_by_ms_ = seen.ms + fade + 5;
        fades_from_ = std::abs(wanted_);
        must_engage_ = must_engage_ || !was_engaged_;
    }
    if (is_held_ && !was_held) {
        if (!was_away) zero_by_ms_ = seen.ms + fade + 5;
        fades_from_ = std::abs(wanted_);
    }
    must_engage_ = must_engage_ || is_held_ || is_bad_ || (is_late_ && !limits_.is_capped);
    if (!has_lost() && !is_held_) return;
    small_ticks_ = ramped_ = 0;
    max_asked_ = 0.0;
    if (seen.is_pressed && is_late_) {
        returns_.clear();
        needed_person_ = needed_person_ || needs_person_;
        needs_person_ = false;
        is_let_ = true;
        pressed_ = seen.logical;
    }
}

/// The node says that there is no fault any more.
void HandRules::come_back(const TickSeen& seen) {
    if (is_nan_) breaks("forces are to come back after a force that is not a number");
    if (is_late_) {
        if (seen.logical - last_late_ < std::max(on_time, limits_.recover_after))
            breaks("forces are to come back before ticks were on time for long enough");
        if (quiet_ticks_ < quiet) breaks("forces are to come back before the hand was without force for long enough");
        if (needs_person_) breaks("forces are to come back for the fourth time in a minute without a person");
        if (limits_.recover_after == 0 && !is_let_) breaks("forces are to come back although the patch says never");
        returns_.push_back(seen.logical);
        ++all_returns_;
        comes_in_ = true;
    }
    if (is_bad_) {
        if (limits_.recover_after == 0) breaks("forces are to come back to a bad device although the patch says never");
        if (seen.logical - last_bad_ < limits_.recover_after) breaks("forces are to come back to a device too soon");
    }
    if (is_late_) needed_person_ = false;
    is_late_ = is_bad_ = false;
    repeats_ = 0;
}

void HandRules::tick(const TickSeen& seen, const DevicePort& port) {
    if (seen.logical - pressed_ > std::max(on_time, limits_.recover_after) + attended) {
        needs_person_ = needs_person_ || (is_late_ && needed_person_);
        needed_person_ = is_let_ = false;
    }
    note_loss(seen);
    if (has_lost() && port.fault == control::Fault::none) come_back(seen);
    if (!has_lost() && port.fault != control::Fault::none) breaks("there is a fault without a reason");
    check_force(seen, port);
    using control::ForceState;
    was_engaged_ = port.state == ForceState::on || port.state == ForceState::ramps;
    const double out = port.wrench.force.x;
    quiet_ticks_ = out == 0.0 && !seen.sample.taken ? quiet_ticks_ + 1 + seen.left_out : 0;
    wanted_ = out;
}

void HandRules::check_force(const TickSeen& seen, const DevicePort& port) {
    const double out = std::abs(port.wrench.force.x), before = std::abs(wanted_);
    const bool rises = out > before + rounding;
    if (has_lost() || is_held_) {
        if (rises) breaks("a force rises while forces are away");
        if (out > 0.0 && seen.ms > zero_by_ms_) breaks("a force has not faded");
        return;
    }
    if (must_engage_) {
        if (rises) breaks("a force comes in although the hand has not left the body");
        small_ticks_ = std::abs(seen.asked) < small ? small_ticks_ + 1 : 0;
        must_engage_ = small_ticks_ < engage_ticks;
        // A return counts from the first force that may be felt.
        if (comes_in_ && !returns_.empty()) returns_.back() = seen.logical;
        return;
    }
    if (!comes_in_) return;
    ++ramped_;
    max_asked_ = std::max(max_asked_, std::min(std::abs(seen.asked), limits_.max_force));
    const double share = static_cast<double>(ramped_) / ramp;
    if (share >= 1.0) comes_in_ = false;
    else if (out > share * max_asked_ + rounding) breaks("a force comes in faster than over half a second");
}

void HandRules::give(double force, bool by_watchdog, std::int64_t ms) {
    const double now = std::abs(force), before = std::abs(given_), change = std::abs(force - given_);
    if (!std::isfinite(force)) breaks("the device is given a force that is not a number");
    if (now > limits_.max_force * (1.0 + rounding)) breaks("the device is given more than the limit");
    const bool turns = force * given_ < 0.0;
    if (turns ? change > limits_.slew + rounding : now > before + limits_.slew + rounding)
        breaks("a force rises faster than the limit");
    if (by_watchdog && now > before + rounding) breaks("the watchdog raises a force");
    // The energy cap takes a force away at once; everything else takes its time.
    const bool fades = by_watchdog || has_lost() || is_held_;
    if (by_watchdog && !was_by_watchdog_) fades_from_ = before;
    was_by_watchdog_ = by_watchdog;
    const auto since = static_cast<double>(std::max<std::int64_t>(1, ms - given_ms_));
    const double fall = std::max(limits_.slew, fades_from_ / fade * since);
    if (!limits_.is_capped && before > now && change > (fades ? fall : limits_.slew) + rounding)
        breaks("a force falls faster than the limit");
    given_ = force;
    given_ms_ = ms;
}

}  // namespace tactus::test
