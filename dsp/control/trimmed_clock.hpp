// SPDX-License-Identifier: Apache-2.0
// Logical time on the steady clock, bent so slowly towards another clock that nobody notices.
#pragma once

#include "dsp/core/time.hpp"

#include <cstdint>

namespace tactus::control {

/// A line through (logical, steady) with a slope near 1. Trimming bends it at its newest point and nowhere else: time
/// never steps, never runs backwards, and never runs faster or slower than `furthest` says.
struct TrimmedClock {
    static constexpr double furthest = 2e-3;  ///< largest deviation of the slope
    static constexpr double pull_s = 5.0;     ///< time constant with which an error of phase is taken back

    Flicks logical = 0;          ///< here the line was bent last
    std::int64_t steady_ns = 0;  ///< and this is when
    double slope = 1.0;          ///< steady ns per logical ns

    /// Steady time of a logical one, ns.
    std::int64_t when(Flicks time) const noexcept;
    /// From logical time `at` on, runs with `slope` of the other clock (steady per logical) and takes back
    /// `error_ns`: what the line is later than it should be.
    void trim(Flicks at, double other_slope, double error_ns) noexcept;
};

}  // namespace tactus::control
