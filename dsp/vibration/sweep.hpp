// SPDX-License-Identifier: Apache-2.0
// Exponential sine sweep (Farina 2000): its distortion of order n equals the sweep at a known earlier time.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::vibration {

/// sin[2π f1 L (e^{t/L} − 1)] with L = T / ln(f2/f1), faded in and out by half cosines (Farina 2000).
struct ExponentialSweep {
    double first = 20.0;    ///< f1, Hz
    double last = 2000.0;   ///< f2, Hz
    double duration = 8.0;  ///< T, s
    double fade = 0.02;     ///< s, at each end

    /// L: the frequency grows e-fold in this time, s.
    double growth() const noexcept { return duration / std::log(last / first); }

    /// Value at time t in s; 0 before the start and after the end.
    double operator()(double t) const noexcept {
        if (!(t >= 0.0) || t > duration) return 0.0;
        const double cycles = first * growth() * std::expm1(t / growth());
        const double edge = std::min(t, duration - t);
        const double gain = edge < fade ? 0.5 - 0.5 * std::cos(std::numbers::pi * edge / fade) : 1.0;
        return gain * std::sin(2.0 * std::numbers::pi * (cycles - std::floor(cycles)));
    }

    /// Lead of distortion order n over the linear response after deconvolution, s.
    double lead(int order) const noexcept { return growth() * std::log(static_cast<double>(order)); }
};

}  // namespace tactus::vibration
