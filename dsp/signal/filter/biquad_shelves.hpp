// SPDX-License-Identifier: Apache-2.0
// Biquads with a gain parameter, and the all-pass: R. Bristow-Johnson, "Cookbook formulae for audio equalizer biquad
// filter coefficients" (W3C note 2021).
#pragma once

#include "dsp/signal/filter/biquad.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::signal {

namespace detail {
/// Root of a gain, kept away from 0.
inline double half_gain(double gain) noexcept { return std::sqrt(std::clamp(gain, 1e-6, 1e6)); }
}  // namespace detail

/// Gain `gain` (a factor) at `frequency`, 1 far from it; frequency/q wide, between the points of half the gain in dB.
inline BiquadCoefficients peak(double frequency, double rate, double q, double gain) noexcept {
    const detail::Warped w(frequency, rate, q);
    const double a = detail::half_gain(gain);
    return detail::normalised(1.0 + w.alpha * a, -2.0 * w.cosine, 1.0 - w.alpha * a, 1.0 + w.alpha / a, -2.0 * w.cosine,
                              1.0 - w.alpha / a);
}

/// Gain `gain` below `frequency`, 1 above, half of it in dB there.
inline BiquadCoefficients low_shelf(double frequency, double rate, double q, double gain) noexcept {
    const detail::Warped w(frequency, rate, q);
    const double a = detail::half_gain(gain), c = w.cosine, s = 2.0 * std::sqrt(a) * w.alpha;
    return detail::normalised(a * (a + 1.0 - (a - 1.0) * c + s), 2.0 * a * (a - 1.0 - (a + 1.0) * c),
                              a * (a + 1.0 - (a - 1.0) * c - s), a + 1.0 + (a - 1.0) * c + s,
                              -2.0 * (a - 1.0 + (a + 1.0) * c), a + 1.0 + (a - 1.0) * c - s);
}

/// Gain `gain` above `frequency`, 1 below, half of it in dB there.
inline BiquadCoefficients high_shelf(double frequency, double rate, double q, double gain) noexcept {
    const detail::Warped w(frequency, rate, q);
    const double a = detail::half_gain(gain), c = w.cosine, s = 2.0 * std::sqrt(a) * w.alpha;
    return detail::normalised(a * (a + 1.0 + (a - 1.0) * c + s), -2.0 * a * (a - 1.0 + (a + 1.0) * c),
                              a * (a + 1.0 + (a - 1.0) * c - s), a + 1.0 - (a - 1.0) * c + s,
                              2.0 * (a - 1.0 - (a + 1.0) * c), a + 1.0 - (a - 1.0) * c - s);
}

/// Gain 1 everywhere; the phase shift is 180° at `frequency`.
inline BiquadCoefficients allpass(double frequency, double rate, double q) noexcept {
    const detail::Warped w(frequency, rate, q);
    return detail::normalised(1.0 - w.alpha, -2.0 * w.cosine, 1.0 + w.alpha, 1.0 + w.alpha, -2.0 * w.cosine,
                              1.0 - w.alpha);
}

}  // namespace tactus::signal
