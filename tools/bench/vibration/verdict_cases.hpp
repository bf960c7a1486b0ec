// SPDX-License-Identifier: Apache-2.0
// Synthetic pairs of vibrations with the same mean spectrum, of which some are alike over time and some are not.
#pragma once

#include "dsp/core/random.hpp"
#include "dsp/signal/spectrum/transform.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <vector>

namespace tactus::bench {

enum class PairKind {
    copy,          ///< delayed, with another gain and noise 26 dB below
    take,          ///< another take of the same source
    random_phase,  ///< the spectrum of the first with random phases
    burst,         ///< noise of the spectrum of the first, all in a third of the time
};
inline constexpr std::array<const char*, 4> pair_names{"copy", "separate take", "random phases", "burst of noise"};

/// What makes the vibrations, at 8 kHz, 4 s. Thresholds are set on the first.
enum class PairSources {
    known,     ///< impacts that ring, strokes of a hand, bursts of teeth
    held_out,  ///< a motor under load that comes and goes, gravel under a wheel, a grip that slips
};

struct VerdictCase {
    static constexpr double rate = 8000.0;
    static constexpr std::size_t count = 32768;
    std::vector<double> reference, output;

    VerdictCase(std::uint64_t seed, PairKind kind, PairSources sources = PairSources::known) {
        const auto source = sources == PairSources::known ? known_source : held_out_source;
        reference = source(seed, 0);
        const Random random{seed * 7 + 5};
        switch (kind) {
            case PairKind::take: output = source(seed, 1); break;
            case PairKind::copy: {
                const auto delay = static_cast<std::size_t>(random.uniform(1) * 6000.0);
                double power = 0.0;
                for (const double x : reference) power += x * x / static_cast<double>(count);
                for (std::size_t i = 0; i < count; ++i)
                    output.push_back(1.7 * (i >= delay ? reference[i - delay] : 0.0) +
                                     0.085 * std::sqrt(power) * random.normal(i + 100));
                break;
            }
            case PairKind::random_phase: output = shuffled(reference, random); break;
            case PairKind::burst:
                output = shuffled(reference, random);
                for (std::size_t i = 0; i < count; ++i) output[i] *= i / (count / 3) == 1 ? std::sqrt(3.0) : 0.05;
                break;
        }
    }

private:
    static std::vector<double> shuffled(const std::vector<double>& x, const Random& random) {
        std::vector<std::complex<double>> half = signal::spectrum_of(x, x.size());
        for (std::size_t k = 1; k + 1 < half.size(); ++k)
            half[k] = std::polar(std::abs(half[k]), 2.0 * std::numbers::pi * random.uniform(k));
        return signal::samples_of(half);
    }
    /// The parameters follow from the seed, the events from seed and take.
    static std::vector<double> held_out_source(std::uint64_t seed, std::uint64_t take) {
        const Random shape{seed}, events{seed * 31 + take * 17 + 1000003};
        constexpr double turn = 2.0 * std::numbers::pi;
        const double line = 50.0 + 120.0 * shape.uniform(1), pace = 1.0 + 3.0 * shape.uniform(2);
        const double ring = 150.0 + 400.0 * shape.uniform(3),
                     decay = std::exp(-1.0 / ((0.004 + 0.02 * shape.uniform(4)) * rate));
        std::vector<double> x(count);
        std::array<double, 2> state{};
        std::uint64_t drawn = 0;
        double noise = 0.0, load = 0.0, wanted = 0.0, next = 0.1, phase = events.uniform(5);
        const double angle = turn * ring / rate;
        for (std::size_t i = 0; i < count; ++i) {
            const double t = static_cast<double>(i) / rate;
            noise = 0.6 * noise + events.normal(i + 1000);
            double hit = 0.0;
            switch (seed % 3) {
                case 0:  // a motor: its load comes and goes, and slows it
                    if (t >= next) wanted = 1.0 - wanted, next += (0.4 + 1.2 * events.uniform(drawn++)) / pace;
                    load += (wanted - load) / (0.02 * rate);
                    phase += line * (1.0 - 0.04 * load) / rate;
                    x[i] = (0.15 + load) *
                           (std::sin(turn * phase) + 0.6 * std::sin(2.0 * turn * phase + 1.0) + 0.5 * noise);
                    continue;
                case 1:  // gravel: hits of very different strength
                    while (t >= next) {
                        hit += std::pow(events.uniform(drawn), -0.6) - 1.0;
                        next += -std::log(events.uniform(drawn + 1)) / (4.0 + 4.0 * pace);
                        drawn += 2;
                    }
                    hit *= 4.0;
                    break;
                default:  // a grip that slips: the force builds up and lets go
                    load += pace * (1.0 + 0.3 * noise) / rate;
                    if (load >= wanted + 0.5) load = 0.0, wanted = events.uniform(drawn++), hit = 25.0;
                    break;
            }
            const double y = hit + 2.0 * decay * std::cos(angle) * state[0] - decay * decay * state[1];
            state = {y, state[0]};
            x[i] = y + 0.1 * noise;
        }
        return x;
    }
    static std::vector<double> known_source(std::uint64_t seed, std::uint64_t take) {
        const Random shape{seed}, events{seed * 31 + take * 17 + 1000003};
        const double ring = 120.0 + 500.0 * shape.uniform(1), line = 60.0 + 150.0 * shape.uniform(2);
        const double pace = 2.0 + 6.0 * shape.uniform(3), level = 0.2 + 0.3 * shape.uniform(4);
        std::vector<double> x(count);
        double noise = 0.0, next = 0.05, envelope = 0.0;
        std::uint64_t drawn = 0;
        std::array<double, 2> state{};
        const double angle = 2.0 * std::numbers::pi * ring / rate, decay = std::exp(-1.0 / (0.01 * rate));
        for (std::size_t i = 0; i < count; ++i) {
            const double t = static_cast<double>(i) / rate;
            noise = 0.7 * noise + events.normal(i + 1000);
            double hit = 0.0, gain = 0.1;
            if (seed % 3 == 0 && t >= next) hit = 20.0, next += (0.7 + 0.6 * events.uniform(drawn++)) / pace;
            const double y = hit + 2.0 * decay * std::cos(angle) * state[0] - decay * decay * state[1];
            state = {y, state[0]};
            if (seed % 3 == 1)
                gain = std::pow(std::max(0.0, std::sin(2.0 * std::numbers::pi * pace * t + 6.28 * events.uniform(7))),
                                3.0);
            if (seed % 3 == 2) {
                if (t >= next) envelope = 1.0, next += (0.8 + 0.4 * events.uniform(drawn++)) / (2.0 * pace);
                envelope *= 1.0 - 12.0 / rate;
                gain = envelope;
            }
            const double lines = std::sin(2.0 * std::numbers::pi * line * t + 6.28 * events.uniform(8)) +
                                 0.5 * std::sin(4.0 * std::numbers::pi * line * t + 1.0);
            x[i] = 0.3 * y + gain * (noise + level * lines) + 0.05 * lines;
        }
        return x;
    }
};

}  // namespace tactus::bench
