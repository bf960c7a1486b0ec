// SPDX-License-Identifier: Apache-2.0
// The last stage before a device: whatever the nodes compute, what comes out is finite, bounded and changes slowly.
#pragma once

#include "dsp/core/types.hpp"

#include <cstdint>

namespace tactus::control {

/// What a device and the hand on it are exposed to at most.
struct ForceLimits {
    double max_force = 10.0;          ///< N
    double max_torque = 0.5;          ///< N·m
    double force_slew = 1000.0;       ///< N/s: 1 N/ms
    double torque_slew = 50.0;        ///< N·m/s
    double engage_force = 0.5;        ///< N: forces start only after they were below this ...
    double engage_torque = 0.05;      ///< N·m: ... and torques below this ...
    int engage_ticks = 3;             ///< ... for so many ticks,
    double engage_ramp_s = 0.1;       ///< and then come in over this time
    int stale_ticks = 10;             ///< ticks without a new sample of the driver that mean it is gone
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
    beyond_drive_limit
};

/// The fault that a number on a wire stands for; what stands for none is invalid input.
inline Fault fault_of_number(double number) noexcept {
    for (int n = 0; n <= static_cast<int>(Fault::beyond_drive_limit); ++n)
        if (number == n) return static_cast<Fault>(n);
    return Fault::invalid_input;
}

/// One clause for people: "a force was not finite".
const char* describe(Fault fault) noexcept;

/// What came in, measured before any limit.
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

/// NaN check, engagement ramp, magnitude limit (direction kept), slew limit, watchdog of the input. A fault fades the
/// output to zero, latches, and says why; `recover` engages anew.
class ForceLimiter {
public:
    /// `period_s` is the nominal tick period: the slew limit allows slew · period per tick, also after skipped ticks,
    /// since the hand feels the step all the same.
    void prepare(const ForceLimits& limits, double period_s);

    /// `raw` is what the nodes want on the hand; `counter` and `valid` are the driver's for this tick's sample.
    Wrench tick(const Wrench& raw, std::int64_t counter, bool valid, double elapsed_s) noexcept;

    /// Starts the fade for a reason found elsewhere. The first reason stays until `recover`.
    void fail(Fault reason) noexcept;

    /// The same where someone else has faded the force already: from here the output is zero at once.
    void cut(Fault reason) noexcept;

    /// While true, forces fade to zero and stay there; afterwards they come back through engagement: a hand that went
    /// deep meanwhile is not thrown out. For changes that are meant.
    void hold_off(bool wanted) noexcept;

    /// Forgets the fault; forces come back through engagement.
    void recover() noexcept;

    Fault fault() const noexcept { return fault_; }
    /// Forces are passed, perhaps still ramping in.
    bool engaged() const noexcept { return fault_ == Fault::none && small_ticks_ >= limits_.engage_ticks; }
    const ForceStatistics& statistics() const noexcept { return statistics_; }

private:
    void measure(const Wrench& raw) noexcept;
    void watch_input(std::int64_t counter, bool valid) noexcept;
    Wrench fade(double elapsed_s) noexcept;
    double engagement(const Wrench& raw, double elapsed_s) noexcept;

    ForceLimits limits_;
    double period_s_ = 0.001;
    Wrench output_, raw_, fade_from_;
    double faded_s_ = 0.0, ramped_s_ = 0.0;
    std::int64_t counter_ = 0;
    int still_ticks_ = 0, small_ticks_ = 0;
    bool has_counter_ = false, held_off_ = false;
    Fault fault_ = Fault::none;
    ForceStatistics statistics_;
};

}  // namespace tactus::control
