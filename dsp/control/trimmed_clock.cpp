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

Flicks TrimmedClock::at(std::int64_t ns) const noexcept {
    const std::int64_t passed_ns = ns - steady_ns;
    const std::int64_t logical_ns =
        passed_ns + static_cast<std::int64_t>(std::floor(static_cast<double>(passed_ns) * (1.0 / slope - 1.0)));
    __extension__ using Wide = __int128;
    constexpr Wide per_second = 1'000'000'000;
    const Wide product = static_cast<Wide>(logical_ns) * flicks_per_second;
    return logical + static_cast<Flicks>(product / per_second - (product % per_second < 0));
}

void TrimmedClock::trim(std::int64_t now_ns, double other_slope, double error_ns) noexcept {
    const Flicks here = at(now_ns);
    steady_ns = when(here);
    logical = here;
    slope = std::clamp(other_slope - error_ns * 1e-9 / pull_s, 1.0 - furthest, 1.0 + furthest);
}

}  // namespace tactus::control
