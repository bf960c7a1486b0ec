// SPDX-License-Identifier: Apache-2.0
// Sawtooth, pulse and triangle with little aliasing.
#pragma once

#include <algorithm>
#include <cmath>

namespace tactus::signal {

/// Geometric waves whose steps and corners are corrected over two samples by polynomials: V. Välimäki and A. Huovilainen,
/// "Antialiasing oscillators in subtractive synthesis", IEEE Signal Processing Magazine 24 (2007), "PolyBLEP"; its
/// integral for the corners of the triangle.
class BandLimitedWave {
public:
    enum class Shape { sawtooth, pulse, triangle };

    /// `rate` in samples per second.
    explicit BandLimitedWave(double rate) noexcept : rate_(rate) {}

    /// Phase of the next sample, in [0, 1).
    double phase() const noexcept { return phase_; }

    /// Returns the next sample, within ±1 except for the corrections. Frequency in Hz; `width`: duty cycle of a pulse.
    double operator()(Shape shape, double frequency, double width) noexcept {
        const double step = std::clamp(frequency / rate_, 0.0, 0.25);
        const double p = phase_;
        double y = 0.0;
        if (shape == Shape::sawtooth) {
            y = 2.0 * p - 1.0 - blep(p, step);
        } else if (shape == Shape::pulse) {
            y = (p < width ? 1.0 : -1.0) + blep(p, step) - blep(turned(p - width), step);
        } else {
            // Corners at 1/4 and 3/4, where the slope changes by 8 per cycle.
            y = p < 0.25 ? 4.0 * p : p < 0.75 ? 2.0 - 4.0 * p : 4.0 * p - 4.0;
            y += 4.0 * step * (blamp(turned(p - 0.75), step) - blamp(turned(p - 0.25), step));
        }
        phase_ = turned(p + step);
        return y;
    }

private:
    static double turned(double x) noexcept {
        const double t = x - std::floor(x);
        return t < 1.0 ? t : 0.0;
    }
    /// Residue of a step of height 2 at phase 0: the band-limited step minus the sharp one.
    static double blep(double p, double step) noexcept {
        if (p < step) {
            const double t = p / step - 1.0;
            return -t * t;
        }
        if (p > 1.0 - step) {
            const double t = (p - 1.0) / step + 1.0;
            return t * t;
        }
        return 0.0;
    }
    /// Residue of a corner at phase 0 whose slope changes by 2 per sample: the integral of `blep`.
    static double blamp(double p, double step) noexcept {
        if (p < step) {
            const double t = 1.0 - p / step;
            return t * t * t / 3.0;
        }
        if (p > 1.0 - step) {
            const double t = 1.0 + (p - 1.0) / step;
            return t * t * t / 3.0;
        }
        return 0.0;
    }

    double rate_, phase_ = 0.0;
};

}  // namespace tactus::signal
