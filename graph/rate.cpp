// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/units.hpp"
#include "graph/patch.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus {

namespace {

constexpr auto whole_second = static_cast<double>(flicks_per_second);

bool is_exact(double hertz) {
    const double period = whole_second / hertz;
    return std::abs(period - std::round(period)) * hertz <= 1e-9 * hertz;
}

/// The exact rate nearest to `hertz` on one side that takes few digits to write.
double short_exact_rate(double hertz, int side) {
    for (double step = std::pow(10.0, std::floor(std::log10(hertz))); step >= 1e-3; step /= 10.0) {
        const double first = side < 0 ? std::floor(hertz / step) : std::ceil(hertz / step);
        for (int i = 0; i < 20; ++i) {
            const double candidate = (first + side * i) * step;
            if (candidate > 0.0 && candidate != hertz && is_exact(candidate) &&
                std::abs(candidate - hertz) < 0.1 * hertz)
                return candidate;
        }
    }
    const double period = side < 0 ? std::ceil(whole_second / hertz) : std::floor(whole_second / hertz);
    return whole_second / period;
}

}  // namespace

Flicks parse_rate(std::string_view text) {
    const double hertz = parse_as(text, "Hz");
    if (!(hertz >= 1e-3 && hertz <= 192000.0))
        throw Error(fmt::format("a rate lies between 0.001 Hz and 192 kHz, not {}", text));
    if (!is_exact(hertz))
        throw Error(fmt::format(
            "{} is not exact: its period is no whole number of 1/705600000 s; the nearest that are: {:.12g} Hz "
            "and {:.12g} Hz",
            text, short_exact_rate(hertz, -1), short_exact_rate(hertz, 1)));
    return std::llround(whole_second / hertz);
}

}  // namespace tactus
