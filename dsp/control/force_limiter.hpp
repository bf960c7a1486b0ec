// SPDX-License-Identifier: Apache-2.0
// Last stage before a device: the output is finite, bounded and slew-limited, whatever the nodes compute.
#pragma once

#include "dsp/core/types.hpp"

#include <cstdint>
#include <limits>

namespace tactus::control {

/// Limits that protect the device and the hand.
struct ForceLimits {
    double max_force = 10.0;          ///< N
    double max_torque = 0.5;          ///< N·m
    double force_slew = 1000.0;       ///< N/s: 1 N/ms
    double torque_slew = 50.0;        ///< N·m/s
    double engage_force = 0.5;  ///< N: forces engage only after they were below this ...
    double engage_torque = 0.05;      ///< N·m: ... and torques below this ...
    int engage_ticks = 3;  ///< ... for this many ticks,
    double engage_ramp_s = 0.1;  ///< and then ramp in over this time
    int stale_ticks = 10;  ///< ticks without a new sample after which the driver counts as lost
    double fade_s = 0.01;             ///< from a fault to zero; may be steeper than the slew limits
};

enum class Fault : std::uint8_t {
    none,
    not_finite,
    stale_input,
    invalid_input,
    late_commit,
    sound_lost,
    stuck_encoder,
    beyond_drive_limit,
    late_source,
    late_value,
    old_world,
    unusable_value
};

/// What the force needs was not there in time; nothing is wrong with the force that was computed, or with the device.
constexpr bool is_lateness(Fault fault) noexcept {
    return fault == Fault::late_commit || (fault >= Fault::late_source && fault <= Fault::unusable_value);
}

/// The fault for a number on a wire; other numbers are invalid input.
inline Fault fault_of_number(double number) noexcept {
    for (int n = 0; n <= static_cast<int>(Fault::unusable_value); ++n)
        if (number == n) return static_cast<Fault>(n);
    return Fault::invalid_input;
}

/// One clause for messages: "a force was not finite".
const char* describe(Fault fault) noexcept;

/// Statistics of the input, before any limit.
struct ForceStatistics {
    std::uint64_t ticks = 0;
    std::uint64_t force_limited = 0;   ///< ticks whose force or torque was above the limit
    std::uint64_t slew_limited = 0;    ///< ticks whose change was above the slew limit
    std::uint64_t limited = 0;         ///< ticks with one or both
    double max_force = 0.0;            ///< N
    double max_torque = 0.0;           ///< N·m
    double max_force_step = 0.0;       ///< N between successive ticks
    double max_torque_step = 0.0;      ///< N·m
};

/// NaN check, engagement ramp, magnitude limit (keeps the direction), slew limit, input watchdog. A fault fades the
/// output to zero and latches with its reason; `recover` re-engages.
class ForceLimiter {
public:
    /// `period_s` is the nominal tick period: the slew limit allows slew · period per tick, also after skipped ticks,
    /// since the hand feels the step all the same.
    void prepare(const ForceLimits& limits, double period_s);

    /// `raw` is the wanted wrench on the hand; `counter` and `valid` are the driver's for this tick's sample.
    Wrench tick(const Wrench& raw, std::int64_t counter, bool valid, double elapsed_s) noexcept;

    /// What the hand was given instead of the last output: the slew limit and a fade go on from there. Before `tick`.
    void start_from(const Wrench& committed) noexcept;

    /// Starts the fade for a fault that the caller found. The first reason stays until `recover`; but lateness, which names
    /// no cause, is replaced by a later one, and every reason by a force that is not finite.
    void fail(Fault reason) noexcept;

    /// The same when another thread has already faded the force: the output is zero at once.
    void cut(Fault reason) noexcept;

    /// While true, forces fade to zero and stay there; afterwards they re-engage: a hand that has moved deep into a
    /// body meanwhile is not thrown out. For intended changes. A slow ramp that was not over begins anew.
    void hold_off(bool wanted) noexcept;

    /// Clears the fault; forces re-engage, and ramp in over at least `min_ramp_s` of ticks that are on time.
    void recover(double min_ramp_s = 0.0) noexcept;

    /// Clears the fault; forces ramp in over at least `ramp_s` of ticks that are on time, also when they are large already.
    /// Whoever calls it sees to it that a hand deep inside of a body is not thrown out: by an energy cap.
    void recover_slowly(double ramp_s) noexcept;

    Fault fault() const noexcept { return fault_; }
    /// Forces are on, possibly still ramping in.
    bool engaged() const noexcept { return fault_ == Fault::none && small_ticks_ >= limits_.engage_ticks; }
    /// Engaged, and not yet in full.
    bool is_ramping() const noexcept { return engaged() && ramped_s_ < ramp(); }
    bool is_held_off() const noexcept { return held_off_; }
    const ForceStatistics& statistics() const noexcept { return statistics_; }

private:
    void measure(const Wrench& raw) noexcept;
    void watch_input(std::int64_t counter, bool valid) noexcept;
    Wrench fade(double elapsed_s) noexcept;
    double engagement(const Wrench& raw, double elapsed_s) noexcept;
    double ramp() const noexcept;

    ForceLimits limits_;
    double period_s_ = 0.001;
    Wrench output_, raw_, fade_from_;
    double faded_s_ = std::numeric_limits<double>::infinity();  ///< since the last fade began
    double ramped_s_ = 0.0, slow_ramp_s_ = 0.0;
    std::int64_t counter_ = 0;
    int still_ticks_ = 0, small_ticks_ = 0;
    bool has_counter_ = false, held_off_ = false;
    Fault fault_ = Fault::none;
    ForceStatistics statistics_;
};

}  // namespace tactus::control
