// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace tactus::signal {

/// Moves towards its target by at most `step` per call and then stays exactly at it.
struct Ramp {
    double step = 1.0, value = 0.0;

    /// Covers a distance of `span` in `seconds`; immediately for 0 s.
    static Ramp over(double span, double seconds, double rate, double start = 0.0) noexcept {
        const double count = seconds * rate;
        return {count > 1.0 ? span / count : span, start};
    }
    double operator()(double target) noexcept {
        if (target > value) return value = std::min(target, value + step);
        return value = std::max(target, value - step);
    }
};

}  // namespace tactus::signal
