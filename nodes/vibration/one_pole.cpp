// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/sample.hpp"
#include "dsp/signal/filter/state_variable.hpp"
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct OnePole {
    static constexpr auto about =
        "First-order filter: 3 dB less at its frequency, 6 dB per octave beyond. A non-finite sample counts as 0.";

    In<Signal> in{"the signal"};
    Out<Signal> out{"the filtered signal"};
    Choice kind{{"lowpass", "highpass"}, "which side passes"};
    Param frequency{"100 Hz", "0.01 Hz", "1 MHz", "corner frequency"};

    void prepare(const Setup& setup) { rate_ = setup.rate(); }
    void process(const Tick& tick) noexcept {
        if (frequency != frequency_) {
            frequency_ = frequency;
            pole_.g = signal::warped_gain(frequency_, rate_);
        }
        const bool is_high = kind.index == 1;
        for (int i = 0; i < tick.frames; ++i) {
            const double x = signal::finite_or_zero(in[i]), low = pole_(x);
            out[i] = signal::to_sample(is_high ? x - low : low);
        }
    }

private:
    signal::TrapezoidalOnePole pole_;
    double rate_ = 48000.0, frequency_ = 0.0;
};

TACTUS_NODE(OnePole, in, out, kind, frequency)

}  // namespace tactus::nodes
