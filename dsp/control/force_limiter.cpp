// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/force_limiter.hpp"

#include "dsp/control/force_bounds.hpp"

#include <algorithm>
#include <limits>

namespace tactus::control {
const char* describe(Fault fault) noexcept {
    switch (fault) {
        case Fault::none: return "no fault";
        case Fault::not_finite: return "a force or torque was not a finite number";
        case Fault::stale_input: return "the device stopped delivering samples";
        case Fault::invalid_input: return "the device delivered an invalid sample";
        case Fault::late_commit: return "no force arrived in time";
        case Fault::sound_lost: return "the sound card was lost";
        case Fault::stuck_encoder: return "the motor was told to run and the encoder stood still";
        case Fault::beyond_drive_limit: return "a motor was told to run faster than it may";
        case Fault::late_source: return "the window that moves the hand was too slow";
        case Fault::late_value: return "a value that the force depends on came too late";
        case Fault::old_world: return "what the force is computed against was not updated for 1 s";
        case Fault::unusable_value: return "a value that the force depends on was not a finite number";
    }
    return "unknown fault";
}

void ForceLimiter::prepare(const ForceLimits& limits, double period_s) {
    *this = ForceLimiter{};
    limits_ = limits;
    period_s_ = period_s;
}

void ForceLimiter::start_from(const Wrench& committed) noexcept {
    if (!is_finite(committed)) return;
    // A fade never grows again: what is left of it is scaled down by what was taken from it.
    const auto share = [](const Vec3& given, const Vec3& wanted) {
        const double most = glm::length(wanted);
        return most > 0.0 ? std::min(1.0, glm::length(given) / most) : 1.0;
    };
    fade_from_.force *= share(committed.force, output_.force);
    fade_from_.torque *= share(committed.torque, output_.torque);
    output_ = committed;
}

void ForceLimiter::fail(Fault reason) noexcept {
    // A late tick says only that something is wrong: a reason that says what replaces it. What is not finite must not be
    // forgotten for a fault that passes.
    const bool replaces = reason == Fault::not_finite || (is_lateness(fault_) && !is_lateness(reason));
    if (fault_ != Fault::none) {
        if (replaces && reason != Fault::none) fault_ = reason;
        return;
    }
    fault_ = reason;
    fade_from_ = output_;
    faded_s_ = 0.0;
}

void ForceLimiter::cut(Fault reason) noexcept {
    fail(reason);
    output_ = fade_from_ = {};
    faded_s_ = std::numeric_limits<double>::infinity();  // nothing is left
}

void ForceLimiter::hold_off(bool wanted) noexcept {
    if (wanted == held_off_) return;
    held_off_ = wanted;
    small_ticks_ = 0;
    // Forces that had not come in yet still come in slowly.
    if (ramped_s_ >= ramp()) slow_ramp_s_ = 0.0;
    ramped_s_ = 0.0;
    if (!wanted || fault_ != Fault::none) return;
    fade_from_ = output_;
    faded_s_ = 0.0;
}

void ForceLimiter::recover(double min_ramp_s) noexcept {
    fault_ = Fault::none;
    has_counter_ = false;
    still_ticks_ = small_ticks_ = 0;
    ramped_s_ = 0.0;
    slow_ramp_s_ = min_ramp_s;
}

void ForceLimiter::recover_slowly(double ramp_s) noexcept {
    recover(ramp_s);
    small_ticks_ = limits_.engage_ticks;
}

double ForceLimiter::ramp() const noexcept { return std::max(limits_.engage_ramp_s, slow_ramp_s_); }

void ForceLimiter::measure(const Wrench& raw) noexcept {
    const Vec3 force_step = raw.force - raw_.force, torque_step = raw.torque - raw_.torque;
    statistics_.max_force = std::max(statistics_.max_force, glm::length(raw.force));
    statistics_.max_torque = std::max(statistics_.max_torque, glm::length(raw.torque));
    statistics_.max_force_step = std::max(statistics_.max_force_step, glm::length(force_step));
    statistics_.max_torque_step = std::max(statistics_.max_torque_step, glm::length(torque_step));
    const bool too_large = glm::length(raw.force) > limits_.max_force || glm::length(raw.torque) > limits_.max_torque;
    const bool too_fast = glm::length(force_step) > limits_.force_slew * period_s_ ||
                          glm::length(torque_step) > limits_.torque_slew * period_s_;
    statistics_.force_limited += too_large;
    statistics_.slew_limited += too_fast;
    statistics_.limited += too_large || too_fast;
    raw_ = raw;
}

void ForceLimiter::watch_input(std::int64_t counter, bool valid) noexcept {
    still_ticks_ = has_counter_ && counter == counter_ ? still_ticks_ + 1 : 0;
    counter_ = counter;
    has_counter_ = true;
    if (!valid) fail(Fault::invalid_input);
    if (still_ticks_ >= limits_.stale_ticks) fail(Fault::stale_input);
}

Wrench ForceLimiter::fade(double elapsed_s) noexcept {
    faded_s_ += elapsed_s > 0.0 ? elapsed_s : period_s_;
    return fade_from_ * fade_left(faded_s_, limits_.fade_s);
}

double ForceLimiter::engagement(const Wrench& raw, double elapsed_s) noexcept {
    if (small_ticks_ < limits_.engage_ticks) {
        const bool is_small =
            glm::length(raw.force) < limits_.engage_force && glm::length(raw.torque) < limits_.engage_torque;
        small_ticks_ = is_small ? small_ticks_ + 1 : 0;
        return 0.0;
    }
    // A slow ramp stands still while ticks are skipped.
    ramped_s_ = std::min(ramped_s_ + (slow_ramp_s_ > 0.0 ? std::min(elapsed_s, period_s_) : elapsed_s), ramp());
    return ramp() > 0.0 ? ramped_s_ / ramp() : 1.0;
}

Wrench ForceLimiter::tick(const Wrench& raw, std::int64_t counter, bool valid, double elapsed_s) noexcept {
    ++statistics_.ticks;
    if (is_finite(raw)) measure(raw);
    else fail(Fault::not_finite);
    watch_input(counter, valid);
    if (fault_ != Fault::none || held_off_) return output_ = fade(elapsed_s);

    // A fade is finished, also when its reason has gone: the slew may be much slower. Small forces count meanwhile.
    if (faded_s_ < limits_.fade_s * (1.0 - 1e-9)) {
        if (!engaged()) (void)engagement(raw, elapsed_s);
        return output_ = fade(elapsed_s);
    }
    const double gain = engagement(raw, elapsed_s);
    const Wrench wanted = ForceBounds{limits_.max_force, limits_.max_torque}.clamp(raw) * gain;
    output_.force += shorten(wanted.force - output_.force, limits_.force_slew * period_s_);
    output_.torque += shorten(wanted.torque - output_.torque, limits_.torque_slew * period_s_);
    return output_;
}

}  // namespace tactus::control
