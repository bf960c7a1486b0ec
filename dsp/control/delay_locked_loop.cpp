// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/delay_locked_loop.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::control {

void DelayLockedLoop::prepare(double rate, double bandwidth) noexcept {
    *this = DelayLockedLoop{};
    nominal_ns_ = frame_ns_ = 1e9 / rate;
    bandwidth_ = bandwidth;
}

void DelayLockedLoop::start(std::int64_t frames, std::int64_t steady_ns) noexcept {
    frames_ = frames;
    time_ns_ = static_cast<double>(steady_ns);
    doubt_s_ = 0.0;
    has_started_ = true;
}

void DelayLockedLoop::update(std::int64_t frames, std::int64_t steady_ns) noexcept {
    if (!has_started_) return start(frames, steady_ns);
    if (frames <= frames_) return;
    const auto passed = static_cast<double>(frames - frames_);
    const double expected_ns = time_ns(frames);
    const double seen_ns = static_cast<double>(steady_ns) - expected_ns;
    const double step_s = passed * frame_ns_ * 1e-9;
    doubt_s_ = std::abs(seen_ns) > furthest_ns ? doubt_s_ + step_s : 0.0;
    if (doubt_s_ > longest_doubt_s) {
        ++jumps_;
        return start(frames, steady_ns);
    }
    const double error_ns = std::clamp(seen_ns, -furthest_ns, furthest_ns);
    // The bandwidth starts wide and falls as 1/age to that of the settled loop.
    age_s_ += step_s;
    const double bandwidth = std::max(bandwidth_, 0.5 / std::max(age_s_, 0.5));
    // Above 0.3 the loop would overshoot.
    const double omega = std::min(2.0 * std::numbers::pi * bandwidth * step_s, 0.3);
    time_ns_ = expected_ns + std::numbers::sqrt2 * omega * error_ns;
    frame_ns_ = std::clamp(frame_ns_ + omega * omega * error_ns / passed, nominal_ns_ / (1.0 + largest_rate_error),
                           nominal_ns_ / (1.0 - largest_rate_error));
    frames_ = frames;
}

}  // namespace tactus::control
