// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/band_limited.hpp"
#include "graph/node/node.hpp"

#include <algorithm>

namespace tactus::nodes {

struct Oscillator {
    static constexpr auto about =
        "Sawtooth, pulse or triangle with little aliasing: steps and corners are smoothed by polynomials over two "
        "samples "
        "(PolyBLEP, Välimäki and Huovilainen 2007). The phase is continuous when the frequency changes.";

    Out<Signal> signal{"the wave"};
    Out<Signal> phase{"rises from 0 to below 1 in each cycle (phasor)"};
    Param frequency{"100 Hz", "0 Hz", "1 MHz", "cycles per second; above a quarter of the rate it acts as that"};
    Param amplitude{"1", "-1e6", "1e6", "peak value"};
    Param width{"50 %", "1 %", "99 %", "share of a pulse's cycle in which it is high"};
    Choice shape{{"sawtooth", "pulse", "triangle"}, "sawtooth rises from -1 to 1; pulse is 1 and then -1"};

    void prepare(const Setup& setup) { wave_ = signal::BandLimitedWave(setup.rate()); }
    void process(const Tick& tick) noexcept {
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
    signal::BandLimitedWave wave_{48000.0};
};

TACTUS_NODE(Oscillator, signal, phase, frequency, amplitude, width, shape)

}  // namespace tactus::nodes
