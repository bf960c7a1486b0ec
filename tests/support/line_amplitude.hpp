// SPDX-License-Identifier: Apache-2.0
// The strength of one frequency in samples, by a sum of its own: no code of the product.
#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <span>

namespace tactus::test {

/// Peak amplitude at `hz` of samples at 1 kHz, under a Hann window.
inline double line_amplitude(std::span<const double> samples, double hz) {
    double mean = 0.0;
    for (const double x : samples) mean += x / static_cast<double>(samples.size());
    std::complex<double> sum = 0.0;
    for (std::size_t n = 0; n < samples.size(); ++n) {
        const double share = static_cast<double>(n) / static_cast<double>(samples.size());
        sum += (samples[n] - mean) * (1.0 - std::cos(2.0 * std::numbers::pi * share)) *
               std::polar(1.0, -2.0 * std::numbers::pi * hz * static_cast<double>(n) / 1000.0);
    }
    return 2.0 * std::abs(sum) / static_cast<double>(samples.size());
}

}  // namespace tactus::test
