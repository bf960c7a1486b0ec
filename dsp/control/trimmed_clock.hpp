// SPDX-License-Identifier: Apache-2.0
// Logical time on the steady clock, slowly trimmed towards another clock.
#pragma once

#include "dsp/core/time.hpp"

#include <cstdint>

namespace tactus::control {

/// A line through (logical, steady) with a slope near 1. Trimming changes its slope where time is at present: time never
/// jumps, never runs backwards, and its rate never deviates by more than `furthest`.
struct TrimmedClock {
    static constexpr double furthest = 2e-3;  ///< largest deviation of the slope
    static constexpr double pull_s = 5.0;  ///< time constant with which a phase error is corrected

    Flicks logical = 0;  ///< start of the present line
    std::int64_t steady_ns = 0;  ///< its steady time
    double slope = 1.0;  ///< steady ns per logical ns

    /// Steady time of a logical time, ns.
    std::int64_t when(Flicks time) const noexcept;
    /// Logical time at a steady time, ns; rounded down.
    Flicks at(std::int64_t ns) const noexcept;
    /// From steady time `now_ns` on, runs at `slope` of the other clock (steady per logical) and corrects `error_ns`, by
    /// which the line is late.
    void trim(std::int64_t now_ns, double other_slope, double error_ns) noexcept;
};

}  // namespace tactus::control
