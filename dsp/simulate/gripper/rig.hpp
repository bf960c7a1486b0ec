// SPDX-License-Identifier: Apache-2.0
// Test rig of thesis 6.3.4.1: a servo swings a cord with two springs that hold the finger between them.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::simulate {

struct RigSprings {
    double stiffness = 190.0;    ///< N/m of each spring; both together 380 N/m at the finger
    double pretension = 0.035;  ///< m, stretch of each at rest; a spring shorter than that is slack

    /// Force on the finger at `finger` with the cord at `cord`, N.
    double force(double cord, double finger) const noexcept {
        const double d = cord - finger;
        return stiffness * (std::max(0.0, pretension + d) - std::max(0.0, pretension - d));
    }
    /// Stiffness at the finger while no spring is slack, N/m.
    double at_finger() const noexcept { return 2.0 * stiffness; }
};

/// Position of the servo. Its phase is continuous when the rate changes.
struct CordSwing {
    double phase = 0.0;  ///< cycles

    /// Position in m after `period` s, oscillating by ±`amplitude` m at `rate` Hz.
    double advance(double amplitude, double rate, double period) noexcept {
        phase += rate * period;
        phase -= std::floor(phase);
        return at(amplitude);
    }
    double at(double amplitude) const noexcept { return amplitude * std::sin(2.0 * std::numbers::pi * phase); }
};

/// Peak speed of the cord, m/s, for a peak-to-peak travel.
inline double peak_cord_speed(double peak_to_peak, double rate) noexcept {
    return std::numbers::pi * peak_to_peak * rate;
}

/// Rate above which a motor of `max_speed` cannot follow a spring of `stiffness` (0: free motion), Hz.
inline double saturation_rate(double max_speed, double amplitude, double rig_stiffness, double stiffness) noexcept {
    return max_speed * (rig_stiffness + stiffness) / (2.0 * std::numbers::pi * amplitude * rig_stiffness);
}

}  // namespace tactus::simulate
