// SPDX-License-Identifier: Apache-2.0
// Synthetic machines with a known rate, for judging the estimator of the fundamental.
#pragma once

#include "dsp/core/random.hpp"
#include "dsp/signal/spectrum/mains.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <vector>

namespace tactus::bench {

/// A machine of 5 Hz to 1 kHz with 1 to 20 orders whose greatest common divisor is 1, sampled at 1 to 48 kHz for 0.5 to 60 s in noise,
/// some with hum of the mains and a rate that wanders.
struct MachineCase {
    double rate = 0.0, seconds = 0.0;  ///< Hz, s
    double frequency = 0.0;  ///< Hz: mean over the record
    double wander = 0.0;  ///< relative amplitude of the rate's slow variation
    double snr_db = 0.0;  ///< of the sum of the orders over all noise
    bool has_first = true, has_hum = false;
    std::vector<int> orders;
    std::vector<double> amplitudes;
    double llr = 0.0;  ///< expected log-likelihood ratio over the best rival for an oracle that knows the orders
    std::vector<double> samples;

    explicit MachineCase(std::uint64_t seed) {
        const Random random{seed};
        std::uint64_t drawn = 0;
        const auto draw = [&](double low, double high) { return low + (high - low) * random.uniform(drawn++); };
        const auto draw_log = [&](double low, double high) { return std::exp(draw(std::log(low), std::log(high))); };
        constexpr double rates[] = {1000.0, 2000.0, 3200.0, 6400.0, 12800.0, 16000.0, 25600.0, 44100.0, 48000.0};
        rate = rates[static_cast<std::size_t>(draw(0.0, 8.999))];
        seconds = draw_log(0.5, 60.0);
        frequency = draw_log(5.0, std::min(1000.0, 0.2 * rate));
        const int highest = static_cast<int>(std::min(20.0, 0.45 * rate / frequency));
        const bool is_scattered = draw(0.0, 1.0) < 0.25;
        do {
            orders.clear();
            const int count = std::min(highest, static_cast<int>(draw_log(1.0, 20.999)));
            if (is_scattered) {
                while (static_cast<int>(orders.size()) < count) {
                    const int k = static_cast<int>(draw(1.0, highest + 0.999));
                    if (std::ranges::find(orders, k) == orders.end()) orders.push_back(k);
                }
            } else {
                for (int k = 1; k <= count; ++k)
                    if (draw(0.0, 1.0) >= (k == 1 ? 0.25 : 0.1)) orders.push_back(k);
            }
        } while (orders.empty() ||
                 std::accumulate(orders.begin(), orders.end(), 0, [](int a, int b) { return std::gcd(a, b); }) != 1);
        std::ranges::sort(orders);
        has_first = orders.front() == 1;
        const double slope = draw(0.0, 2.0);
        double power = 0.0, strongest = 0.0;
        for (const int k : orders) {
            amplitudes.push_back(std::pow(k, -slope) * std::pow(10.0, draw(-8.0, 8.0) / 20.0));
            strongest = std::max(strongest, amplitudes.back());
        }
        for (double& a : amplitudes) a = std::max(a, 0.01 * strongest), power += 0.5 * a * a;
        snr_db = draw(-10.0, 40.0);
        const double noise = std::sqrt(power * std::pow(10.0, -0.1 * snr_db));
        wander = draw(0.0, 1.0) < 0.5 ? 0.0 : draw_log(3e-4, 0.03);
        const double speed = draw_log(0.1, 2.0), start = draw(0.0, 6.28);
        has_hum = draw(0.0, 1.0) < 0.25;
        const double mains = draw(0.0, 1.0) < 0.5 ? 50.0 : 60.0,
                     hum = strongest * std::pow(10.0, draw(-20.0, 6.0) / 20.0);
        const double pole = draw(0.0, 1.0) < 0.5 ? 0.0 : 0.9;
        std::vector<std::complex<double>> phases;
        for (std::size_t i = 0; i < orders.size(); ++i) phases.push_back(std::polar(amplitudes[i], draw(0.0, 6.28)));
        samples.resize(static_cast<std::size_t>(seconds * rate));
        double phase = 0.0, sum = 0.0, dull = 0.0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const double t = static_cast<double>(i) / rate;
            const double f = frequency * (1.0 + wander * std::sin(2.0 * std::numbers::pi * speed * t + start));
            sum += f;
            phase += f / rate;
            const std::complex<double> turn = std::polar(1.0, 2.0 * std::numbers::pi * (phase - std::floor(phase)));
            std::complex<double> power_of = 1.0;
            double y = 0.0;
            for (std::size_t at = 0, k = 1; at < orders.size(); ++k) {
                power_of *= turn;
                if (static_cast<int>(k) == orders[at]) y += (power_of * phases[at++]).real();
            }
            if (has_hum)
                for (int m = 1; m <= 3 && m * mains < 0.45 * rate; ++m)
                    y += hum / (m * m) * std::sin(2.0 * std::numbers::pi * mains * m * t + m);
            dull = pole * dull + std::sqrt(1.0 - pole * pole) * random.normal(i + 1'000'000);
            samples[i] = y + noise * dull;
        }
        const double told = frequency;
        frequency = sum / static_cast<double>(samples.size());
        // Oracle: a line spread over M cells of 1/T has M·(x − ln(1 + x)) with x = energy over noise of a cell.
        std::vector<double> weights;
        for (std::size_t i = 0; i < orders.size(); ++i) {
            const double cells = 1.0 + 2.0 * orders[i] * told * wander * std::min(1.0, 2.0 * speed * seconds) * seconds;
            const double angle = 2.0 * std::numbers::pi * orders[i] * told / rate;
            const double shape = (1.0 - pole * pole) / (1.0 - 2.0 * pole * std::cos(angle) + pole * pole);
            const double x = amplitudes[i] * amplitudes[i] * static_cast<double>(samples.size()) /
                             (4.0 * noise * noise * shape * cells);
            weights.push_back(cells * (x - std::log1p(x)));
        }
        const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
        double rival = std::log(2.0 * seconds * 1000.0);  // noise alone
        for (int p = 1; p <= 20; ++p)
            for (int q = 1; q <= 20; ++q) {
                // The rate told·p/q.
                const double f = told * p / q;
                if (p == q || std::gcd(p, q) != 1 || f < 5.0 || f > 1000.0) continue;
                double kept = 0.0;
                for (std::size_t i = 0; i < orders.size(); ++i)
                    if (orders[i] % p == 0 && std::ranges::find(orders, orders[i] / p * q) != orders.end())
                        kept += weights[i];
                rival = std::max(rival, kept);
            }
        // Hum of a mains that is up to `mains_range` off has the orders of a machine at its frequency, at twice and at
        // six times it. A rate that moves is a machine's, and so is one beside hum of another frequency.
        const double resolution = 1.0 / seconds;
        for (const int nominal : signal::mains_frequencies) {
            const int order = signal::mains_order(told, nominal);
            const bool is_off = has_hum && nominal == static_cast<int>(mains) &&
                                std::abs(told - order * mains) > resolution + signal::mains_drift * told;
            if (order > 0 && signal::is_hum_family(order) && wander < signal::mains_drift && !is_off) rival = all;
        }
        llr = told * seconds >= 2.0 ? all - rival : 0.0;
    }

    bool is_right(double estimate) const { return std::abs(estimate / frequency - 1.0) < 0.005 + 1.2 * wander; }
    bool oracle_tells() const { return llr >= 10.0; }
};

}  // namespace tactus::bench
