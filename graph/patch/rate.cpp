// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/units.hpp"
#include "graph/patch/patch.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus::patch {

namespace {

constexpr auto whole_second = static_cast<double>(flicks_per_second);

bool is_exact(double hertz) {
    const double period = whole_second / hertz;
    // The quotient is rounded, by up to one part in 1e16.
    return std::abs(period - std::round(period)) <= 1e-9 + 1e-15 * period;
}

/// An exact rate near `hertz`, on one side of it, with at most four digits: the one with the fewest. Most other exact
/// rates have no finite decimal.
double short_exact_rate(double hertz, int side) {
    const double magnitude = std::floor(std::log10(hertz));
    // The search ends at a power of ten or at 192 kHz: these are exact.
    for (double near = 0.01;; near *= 10.0)
        for (int digits = 1; digits <= 4; ++digits) {
            const double step = std::pow(10.0, magnitude + 1 - digits);
            double multiple = side < 0 ? std::floor(hertz / step) : std::ceil(hertz / step);
            for (; multiple > 0.0 && std::abs(multiple * step - hertz) <= near * hertz; multiple += side)
                if (is_exact(multiple * step)) return multiple * step;
        }
}

}  // namespace

Flicks parse_rate(std::string_view text) {
    const double hertz = parse_as(text, "Hz");
    if (!(hertz >= 1e-3 && hertz <= 192000.0))
        throw Error(fmt::format("a rate lies between 0.001 Hz and 192 kHz, not {}", text));
    if (!is_exact(hertz))
        throw Error(fmt::format(
            "{} is not exact: its period is no whole number of 1/705600000 s; rates near it that are: {:.6g} Hz "
            "and {:.6g} Hz",
            text, short_exact_rate(hertz, -1), short_exact_rate(hertz, 1)));
    return std::llround(whole_second / hertz);
}

}  // namespace tactus::patch
