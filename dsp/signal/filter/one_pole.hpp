// SPDX-License-Identifier: Apache-2.0
// First-order low-pass; smoother and envelope follower.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::signal {

/// Step response of a first-order lag after `dt` (both in s): 1 − e^(−dt/τ); 1 for τ ≤ 0.
inline double lag_share(double time_constant, double dt) noexcept {
    return time_constant > 0.0 ? -std::expm1(-dt / time_constant) : 1.0;
}

/// y += share (x − y). The step response equals that of the analog lag; −3 dB at 1/(2πτ) while that is far below the
/// rate. Never overshoots.
struct OnePole {
    double share = 1.0, y = 0.0;

    static OnePole from_cutoff(double frequency, double rate) noexcept {
        return {lag_share(1.0 / (2.0 * std::numbers::pi * std::max(frequency, 1e-9)), 1.0 / rate), 0.0};
    }
    static OnePole from_time_constant(double seconds, double rate) noexcept {
        return {lag_share(seconds, 1.0 / rate), 0.0};
    }
    double operator()(double x) noexcept { return y += share * (x - y); }
};

/// Follows |x| with separate time constants for rise (attack) and fall (release), s.
struct EnvelopeFollower {
    double attack_share = 1.0, release_share = 1.0, y = 0.0;

    EnvelopeFollower() = default;
    EnvelopeFollower(double attack, double release, double rate) noexcept
        : attack_share(lag_share(attack, 1.0 / rate)), release_share(lag_share(release, 1.0 / rate)) {}
    double operator()(double x) noexcept {
        const double level = std::abs(x);
        return y += (level > y ? attack_share : release_share) * (level - y);
    }
};

}  // namespace tactus::signal
