// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/biquad.hpp"
#include "dsp/signal/filter/sample.hpp"
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Filter {
    static constexpr auto about =
        "Second-order filter (biquad). A non-finite sample counts as 0; frequencies above half the rate act as just "
        "below.";
    static constexpr UnitRule units = UnitRule::same;

    In<Signal> in{"the signal"};
    Out<Signal> out{"the filtered signal"};
    Choice kind{{"lowpass", "highpass", "bandpass", "notch"}, "filter type"};
    Param frequency{"1 kHz", "0.1 Hz", "1 MHz", "corner frequency, or centre frequency of bandpass and notch"};
    Param q{"0.70710678", "0.05", "200",
            "lowpass, highpass: gain at the corner; bandpass, notch: centre frequency divided by the -3 dB bandwidth"};

    void prepare(const Setup& setup) { rate_ = setup.rate(); }

    void process(const Tick& tick) noexcept {
        if (frequency != frequency_ || q != q_) design();
        for (int i = 0; i < tick.frames; ++i) out[i] = signal::to_sample(section_(signal::finite_or_zero(in[i])));
    }

private:
    void design() noexcept {
        frequency_ = frequency;
        q_ = q;
        using Design = signal::BiquadCoefficients (*)(double, double, double) noexcept;
        constexpr Design designs[] = {signal::lowpass, signal::highpass, signal::bandpass, signal::notch};
        section_.coefficients = designs[kind.index](frequency_, rate_, q_);
    }

    signal::Biquad section_;
    double rate_ = 48000.0, frequency_ = 0.0, q_ = 0.0;
};

TACTUS_NODE(Filter, in, out, kind, frequency, q)

}  // namespace tactus::nodes
