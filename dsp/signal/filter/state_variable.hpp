// SPDX-License-Identifier: Apache-2.0
// One-pole and state-variable filters by trapezoidal integration (topology-preserving transform): V. Zavalishin, "The Art
// of VA Filter Design" (2012), chapters 3 and 4. The given frequency is exact, and may change at each sample.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::signal {

/// Returns tan(π f / rate), with f clamped to the range of the rate.
inline double warped_gain(double frequency, double rate) noexcept {
    return std::tan(std::numbers::pi * std::clamp(frequency / rate, 1e-9, 0.4999));
}

/// First-order low-pass; the high-pass is the remainder.
struct TrapezoidalOnePole {
    double g = 1.0;  ///< of `warped_gain`
    double state = 0.0;

    double operator()(double x) noexcept {
        const double v = (x - state) * (g / (1.0 + g)), low = v + state;
        state = low + v;
        return low;
    }
};

struct StateVariable {
    struct Outputs {
        double low, band, high;  ///< `band` has gain 1 at the frequency
    };

    void set(double frequency, double rate, double q) noexcept {
        const double g = warped_gain(frequency, rate);
        damping = 1.0 / std::max(q, 1e-3);
        a1 = 1.0 / (1.0 + g * (g + damping));
        a2 = g * a1;
        a3 = g * a2;
    }
    Outputs operator()(double x) noexcept {
        const double v3 = x - second, v1 = a1 * first + a2 * v3, v2 = second + a2 * first + a3 * v3;
        first = 2.0 * v1 - first;
        second = 2.0 * v2 - second;
        return {v2, damping * v1, x - damping * v1 - v2};
    }

    double damping = 1.0, a1 = 1.0, a2 = 0.0, a3 = 0.0;
    double first = 0.0, second = 0.0;  ///< states of both integrators
};

}  // namespace tactus::signal
