// SPDX-License-Identifier: Apache-2.0
// Biquad filters: the analog prototypes of Bristow-Johnson's cookbook through the bilinear transform, prewarped so
// that the given frequency is exact.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace tactus::signal {

/// y = b0 x + b1 x' + b2 x'' − a1 y' − a2 y''.
struct BiquadCoefficients {
    double b0 = 1.0, b1 = 0.0, b2 = 0.0, a1 = 0.0, a2 = 0.0;

    /// Complex gain at `frequency` (Hz) when run at `rate` (Hz).
    std::complex<double> response(double frequency, double rate) const {
        const std::complex<double> z = std::polar(1.0, -2.0 * std::numbers::pi * frequency / rate);
        return (b0 + z * (b1 + z * b2)) / (1.0 + z * (a1 + z * a2));
    }
};

/// Quality factor of a maximally flat (Butterworth) second-order section: −3 dB at its frequency.
inline constexpr double butterworth_q = std::numbers::sqrt2 / 2.0;

namespace detail {
struct Warped {
    double cosine, alpha;
    /// Clamps frequencies to the range of the rate, so that a live parameter cannot make the filter unstable.
    Warped(double frequency, double rate, double q) noexcept {
        const double w = 2.0 * std::numbers::pi * std::clamp(frequency / rate, 1e-7, 0.4999);
        cosine = std::cos(w);
        alpha = std::sin(w) / (2.0 * std::max(q, 1e-3));
    }
};
inline BiquadCoefficients normalised(double b0, double b1, double b2, double a0, double a1, double a2) noexcept {
    return {b0 / a0, b1 / a0, b2 / a0, a1 / a0, a2 / a0};
}
}  // namespace detail

/// Frequency and rate in Hz; the gain at `frequency` is `q`, 1 at 0 Hz, and falls 12 dB per octave above.
inline BiquadCoefficients lowpass(double frequency, double rate, double q = butterworth_q) noexcept {
    const detail::Warped w(frequency, rate, q);
    const double side = (1.0 - w.cosine) / 2.0;
    return detail::normalised(side, 2.0 * side, side, 1.0 + w.alpha, -2.0 * w.cosine, 1.0 - w.alpha);
}

/// Counterpart of `lowpass`: rises 12 dB per octave up to `frequency`, gain 1 above.
inline BiquadCoefficients highpass(double frequency, double rate, double q = butterworth_q) noexcept {
    const detail::Warped w(frequency, rate, q);
    const double side = (1.0 + w.cosine) / 2.0;
    return detail::normalised(side, -2.0 * side, side, 1.0 + w.alpha, -2.0 * w.cosine, 1.0 - w.alpha);
}

/// Gain 1 at `frequency`; the −3 dB band is frequency/q wide and falls 6 dB per octave on both sides.
inline BiquadCoefficients bandpass(double frequency, double rate, double q) noexcept {
    const detail::Warped w(frequency, rate, q);
    return detail::normalised(w.alpha, 0.0, -w.alpha, 1.0 + w.alpha, -2.0 * w.cosine, 1.0 - w.alpha);
}

/// Zero at `frequency`, gain 1 far from it; the −3 dB band is frequency/q wide.
inline BiquadCoefficients notch(double frequency, double rate, double q) noexcept {
    const detail::Warped w(frequency, rate, q);
    return detail::normalised(1.0, -2.0 * w.cosine, 1.0, 1.0 + w.alpha, -2.0 * w.cosine, 1.0 - w.alpha);
}

/// One section in transposed direct form II. New coefficients may be set at any time; the state stays.
struct Biquad {
    BiquadCoefficients coefficients;
    double s1 = 0.0, s2 = 0.0;

    double operator()(double x) noexcept {
        const auto& c = coefficients;
        const double y = c.b0 * x + s1;
        s1 = c.b1 * x - c.a1 * y + s2;
        s2 = c.b2 * x - c.a2 * y;
        return y;
    }
};

}  // namespace tactus::signal
