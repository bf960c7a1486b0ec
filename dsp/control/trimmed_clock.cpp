// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/trimmed_clock.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::control {

std::int64_t TrimmedClock::when(Flicks time) const noexcept {
    // Multiplying only the deviation keeps full resolution after days.
    const std::int64_t passed_ns = nanoseconds(time - logical);
    return steady_ns + passed_ns + std::llround(static_cast<double>(passed_ns) * (slope - 1.0));
}

void TrimmedClock::trim(Flicks at, double other_slope, double error_ns) noexcept {
    steady_ns = when(at);
    logical = at;
    slope = std::clamp(other_slope - error_ns * 1e-9 / pull_s, 1.0 - furthest, 1.0 + furthest);
}

}  // namespace tactus::control
