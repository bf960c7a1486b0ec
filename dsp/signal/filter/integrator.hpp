// SPDX-License-Identifier: Apache-2.0
// Integration of a vibration over time, with a high-pass: acceleration to velocity or displacement.
#pragma once

#include "dsp/signal/filter/biquad.hpp"

#include <array>
#include <complex>
#include <cstddef>

namespace tactus::signal {

/// One integration: s/(s² + √2 ω0 s + ω0²), which is 1/s with a Butterworth high-pass of second order, so that no offset
/// accumulates. The integral over a sample is that of the band-limited interpolation (33 taps): gain within 0.05 % of
/// 1/(2π f) from 20 times the high-pass to 0.45 times the rate, where the trapezium rule is 70 % too low. Latency: 16
/// samples.
class Integrator {
public:
    /// Frequencies in Hz. Throws Error unless 0 < high_pass < rate / 20.
    Integrator(double high_pass, double rate);
    double operator()(double x) noexcept;
    std::complex<double> response(double frequency) const;
    /// Resets the state to 0.
    void reset() noexcept;

private:
    static constexpr std::size_t half = 16, taps = 2 * half + 1;
    double rate_;
    std::array<double, taps> tap_{}, past_{};
    std::size_t at_ = 0;
    Biquad high_pass_;
};

}  // namespace tactus::signal
