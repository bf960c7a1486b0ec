// SPDX-License-Identifier: Apache-2.0
// Values between samples, by a windowed sinc.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace tactus::vibration {

/// Windowed sinc with `half` zero crossings on each side (Blackman window), finely tabulated with linear interpolation.
struct SincKernel {
    static constexpr int steps = 512;
    int half;
    std::vector<double> table;

    /// Allocates.
    explicit SincKernel(int crossings);
    double operator()(double x) const noexcept {
        const double position = std::abs(x) * steps;
        const auto i = static_cast<std::int64_t>(position);
        if (i + 1 >= static_cast<std::int64_t>(table.size())) return 0.0;
        const double part = position - static_cast<double>(i), *const at = table.data() + i;
        return at[0] + part * (at[1] - at[0]);
    }
};

constexpr int reading_half = 8, reading_taps = 2 * reading_half;

/// `samples`: 16 of them; x in [0, 1] lies between the eighth and the ninth. Flat up to a third of the sample rate.
double read_between(const float* samples, double x) noexcept;

}  // namespace tactus::vibration
