// SPDX-License-Identifier: Apache-2.0
// Delay-locked loop: the rate and phase of a clock that is observed through jittered callbacks.
#pragma once

#include <cstdint>

namespace tactus::control {

/// Second-order delay-locked loop over pairs (frame count, time): a smooth time for every frame and the true duration
/// of a frame. A constant rate difference leaves no error in time. Callbacks may have any size and may be missing.
/// After F. Adriaensen, "Using a DLL to filter time", LAC 2005; the loop starts wide and narrows, so that it locks
/// within seconds.
class DelayLockedLoop {
public:
    /// `rate` is the nominal rate, Hz; `bandwidth` that of the settled loop, Hz.
    void prepare(double rate, double bandwidth = 0.05) noexcept;

    /// The count was `frames` at `steady_ns`. Counts and times must rise; a pair that does not is ignored. Deviations
    /// are clamped to 5 ms: one late wake-up has little effect. After `longest_doubt_s` of such deviations the clock
    /// counts as having jumped, and the loop restarts there with its present rate.
    void update(std::int64_t frames, std::int64_t steady_ns) noexcept;

    /// Time at which the count reaches that number of frames, ns of the steady clock. After the first `update`.
    double time_ns(std::int64_t frames) const noexcept {
        return time_ns_ + static_cast<double>(frames - frames_) * frame_ns_;
    }
    double frame_ns() const noexcept { return frame_ns_; }
    /// Relative rate deviation of the clock: 1e-6 is 1 ppm fast.
    double rate_error() const noexcept { return nominal_ns_ / frame_ns_ - 1.0; }
    bool has_started() const noexcept { return has_started_; }
    std::int64_t jumps() const noexcept { return jumps_; }

    static constexpr double longest_doubt_s = 0.5;
    static constexpr double furthest_ns = 5e6;
    static constexpr double largest_rate_error = 1e-3;  ///< a clock that deviates more does not have that rate

private:
    void start(std::int64_t frames, std::int64_t steady_ns) noexcept;

    double nominal_ns_ = 1e9 / 48000.0, frame_ns_ = nominal_ns_, bandwidth_ = 0.05;
    double time_ns_ = 0.0, age_s_ = 0.0, doubt_s_ = 0.0;
    std::int64_t frames_ = 0, jumps_ = 0;
    bool has_started_ = false;
};

}  // namespace tactus::control
