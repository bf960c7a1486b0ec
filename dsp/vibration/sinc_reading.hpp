// SPDX-License-Identifier: Apache-2.0
// Values between samples, by a windowed sinc.
#pragma once

#include <vector>

namespace tactus::vibration {

/// Windowed sinc with `half` zero crossings on each side (Blackman window), finely tabulated with linear interpolation.
struct SincKernel {
    static constexpr int steps = 512;
    int half;
    std::vector<double> table;

    /// Allocates.
    explicit SincKernel(int crossings);
    double operator()(double x) const noexcept;
};

constexpr int reading_half = 8, reading_taps = 2 * reading_half;

/// `samples`: 16 of them; x in [0, 1] lies between the eighth and the ninth. Flat up to a third of the sample rate.
double read_between(const float* samples, double x) noexcept;

}  // namespace tactus::vibration
