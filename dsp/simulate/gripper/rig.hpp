// SPDX-License-Identifier: Apache-2.0
// The test rig of thesis 6.3.4.1: a servo swings a cord in which two springs hold the finger between them.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::simulate {

struct RigSprings {
    double stiffness = 190.0;    ///< N/m of each spring; both together 380 N/m at the finger
    double pretension = 0.035;   ///< m by which each is stretched at rest; a spring that gets short goes slack

    /// On the finger at `finger` with the cord at `cord`, N.
    double force(double cord, double finger) const noexcept {
        const double d = cord - finger;
        return stiffness * (std::max(0.0, pretension + d) - std::max(0.0, pretension - d));
    }
    /// At the finger while neither is slack, N/m.
    double at_finger() const noexcept { return 2.0 * stiffness; }
};

/// Where the servo has the cord. Its phase does not jump when the rate changes.
struct CordSwing {
    double phase = 0.0;  ///< cycles

    /// Position in m, `period` s later, swinging `amplitude` m to each side `rate` times per second.
    double advance(double amplitude, double rate, double period) noexcept {
        phase += rate * period;
        phase -= std::floor(phase);
        return at(amplitude);
    }
    double at(double amplitude) const noexcept { return amplitude * std::sin(2.0 * std::numbers::pi * phase); }
};

/// Largest speed of the cord, m/s, for so much from end to end.
inline double peak_cord_speed(double peak_to_peak, double rate) noexcept {
    return std::numbers::pi * peak_to_peak * rate;
}

/// Rate from which on a motor of `max_speed` cannot follow a spring of `stiffness` any more (0: free motion), Hz.
inline double saturation_rate(double max_speed, double amplitude, double rig_stiffness, double stiffness) noexcept {
    return max_speed * (rig_stiffness + stiffness) / (2.0 * std::numbers::pi * amplitude * rig_stiffness);
}

}  // namespace tactus::simulate
