// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/band_limited.hpp"
#include "dsp/signal/filter/fast_sine.hpp"
#include "graph/node/node.hpp"

#include <algorithm>
#include <cstdint>

namespace tactus::nodes {

struct Oscillator {
    static constexpr auto about =
        "Sawtooth, pulse, triangle or sine, with little aliasing: steps and corners are smoothed by polynomials over "
        "two "
        "samples "
        "(PolyBLEP, Välimäki and Huovilainen 2007). The phase is continuous when the frequency changes.";

    Out<Signal> signal{"the wave"};
    Out<Signal> phase{"rises from 0 to below 1 in each cycle (phasor)"};
    Param frequency{"100 Hz", "0 Hz", "1 MHz", "cycles per second; above a quarter of the rate it acts as that"};
    Param amplitude{"1", "-1e6", "1e6", "peak value"};
    Param width{"50 %", "1 %", "99 %", "share of a pulse's cycle in which it is high"};
    Choice shape{{"sawtooth", "pulse", "triangle", "sine"},
                 "sawtooth rises from -1 to 1; pulse is 1 and then -1; sine is within 1e-7 of the true one and cheap"};

    void prepare(const Setup& setup) {
        wave_ = signal::BandLimitedWave(setup.rate());
        rate_ = setup.rate();
        sine_ = {};
    }
    void process(const Tick& tick) noexcept {
        if (shape.index == 3) return process_sine(tick.frames);
        using Shape = signal::BandLimitedWave::Shape;
        constexpr Shape shapes[] = {Shape::sawtooth, Shape::pulse, Shape::triangle};
        const double a = amplitude;
        for (int i = 0; i < tick.frames; ++i) {
            // The last phases of a cycle would round up to 1.
            phase[i] = std::min(static_cast<float>(wave_.phase()), 0x1.fffffep-1f);
            signal[i] = static_cast<float>(a * wave_(shapes[shape.index], frequency, width));
        }
    }

private:
    void process_sine(int frames) noexcept {
        const std::uint64_t step = signal::WavePhase::step(std::min(frequency / rate_, 0.25)), begin = sine_.phase;
        const auto a = static_cast<float>(amplitude);
        float *const wave = &signal[0], *const cycle = &phase[0];
        for (int i = 0; i < frames; ++i) {
            const std::uint64_t now = begin + static_cast<std::uint64_t>(i) * step;
            wave[i] = a * signal::fast_sine(static_cast<std::int32_t>(now >> 32));
            cycle[i] = static_cast<float>(static_cast<std::int32_t>(now >> 40)) * 0x1.0p-24f;
        }
        sine_.phase = begin + static_cast<std::uint64_t>(frames) * step;
    }

    signal::BandLimitedWave wave_{48000.0};
    signal::WavePhase sine_;
    double rate_ = 48000.0;
};

TACTUS_NODE(Oscillator, signal, phase, frequency, amplitude, width, shape)

}  // namespace tactus::nodes
