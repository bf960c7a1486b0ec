// SPDX-License-Identifier: Apache-2.0
// An actuator on a handle as a test plant, and saws to play on it: what is inside is known exactly.
#pragma once

#include "dsp/core/random.hpp"
#include "dsp/signal/filter/biquad.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <vector>

namespace tactus::test {

/// A resonant peak (or, below 0 dB, a dip) of that gain at `frequency` and 1 far from it.
inline signal::BiquadCoefficients bell(double frequency, double rate, double gain_db, double q) {
    const double a = std::pow(10.0, gain_db / 40.0);
    const double w = 2.0 * std::numbers::pi * frequency / rate, alpha = std::sin(w) / (2.0 * q), c = std::cos(w);
    const double a0 = 1.0 + alpha / a;
    return {(1.0 + alpha * a) / a0, -2.0 * c / a0, (1.0 - alpha * a) / a0, -2.0 * c / a0, (1.0 - alpha / a) / a0};
}

/// A mass on a spring (acceleration per force), three modes of the handle and the sensor's low-pass.
struct Plant {
    double rate = 48000.0, resonance = 75.0, damping = 0.25, mode = 180.0;

    std::array<signal::BiquadCoefficients, 5> sections() const {
        return {signal::highpass(resonance, rate, 1.0 / (2.0 * damping)), bell(mode, rate, 9.0, 4.0),
                bell(420.0, rate, -8.0, 6.0), bell(640.0, rate, 7.0, 5.0), signal::lowpass(1400.0, rate)};
    }
    std::complex<double> gain(double frequency) const {
        std::complex<double> product = 1.0;
        for (const signal::BiquadCoefficients& section : sections()) product *= section.response(frequency, rate);
        return product;
    }
    std::vector<float> operator()(const std::vector<float>& drive) const {
        std::array<signal::Biquad, 5> filters;
        const auto all = sections();
        for (std::size_t i = 0; i < all.size(); ++i) filters[i].coefficients = all[i];
        std::vector<float> out;
        out.reserve(drive.size());
        for (const float x : drive) {
            double y = static_cast<double>(x);
            for (signal::Biquad& filter : filters) y = filter(y);
            out.push_back(static_cast<float>(y));
        }
        return out;
    }
};

/// Mains hum and noise of a measurement, in dB re an amplitude of 1 and an rms of 1.
inline void add_disturbance(std::vector<float>& samples, double rate, double hum_db, double noise_db,
                            std::uint64_t seed) {
    const Random random{seed};
    const double hum = std::pow(10.0, hum_db / 20.0), noise = std::pow(10.0, noise_db / 20.0);
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] +=
            static_cast<float>(hum * std::sin(2.0 * std::numbers::pi * 50.0 * static_cast<double>(i) / rate + 0.4) +
                               noise * random.normal(i));
}

/// A saw of ten orders; when it cuts, noise of 300 to 1500 Hz swells twice a cycle.
inline std::vector<float> saw(double strokes, bool cutting, double duration, double rate, std::uint64_t seed) {
    constexpr std::array<double, 10> levels{1.0, 0.5, 0.35, 0.25, 0.2, 0.15, 0.1, 0.08, 0.05, 0.04};
    const Random phases{seed}, random{seed + 1000};
    signal::Biquad above{signal::highpass(300.0, rate)}, below{signal::lowpass(1500.0, rate)};
    std::vector<float> out(static_cast<std::size_t>(duration * rate));
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double cycles = strokes * static_cast<double>(i) / rate;
        double sum = 1e-4 * random.normal(2 * i);
        for (std::size_t k = 0; k < levels.size(); ++k)
            sum += levels[k] *
                   std::sin(2.0 * std::numbers::pi * (static_cast<double>(k + 1) * cycles + phases.uniform(k)));
        if (cutting)
            sum += below(above(4.0 * random.normal(2 * i + 1) * std::abs(std::sin(2.0 * std::numbers::pi * cycles))));
        out[i] = static_cast<float>(0.5 * sum);
    }
    return out;
}

}  // namespace tactus::test
