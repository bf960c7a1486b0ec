// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/oscillator.hpp"
#include "graph/node/node.hpp"

#include <cmath>
#include <numbers>

namespace tactus::nodes {

struct Sine {
    static constexpr auto about = "A sine oscillator. Its phase is continuous when the frequency changes.";

    Out<Signal> signal{"amplitude × sin(2π frequency t + phase)"};
    Param frequency{"100 Hz", "0 Hz", "1 MHz", "cycles per second"};
    Param amplitude{"1", "-1e6", "1e6", "peak value"};
    Param phase{structural, "0 deg", "-360 deg", "360 deg", "at the start"};

    void prepare(const Setup& setup) {
        oscillator_.rate = setup.rate();
        const double cycles = phase / (2.0 * std::numbers::pi);
        oscillator_.phase = static_cast<std::uint64_t>(std::llround((cycles - std::round(cycles)) * 0x1.0p62)) << 2;
    }

    void process(const Tick& tick) noexcept {
        const double f = frequency, a = amplitude;
        for (int i = 0; i < tick.frames; ++i) signal[i] = static_cast<float>(a * oscillator_(f));
    }

private:
    signal::SineOscillator oscillator_;
};

TACTUS_NODE(Sine, signal, frequency, amplitude, phase)

}  // namespace tactus::nodes
