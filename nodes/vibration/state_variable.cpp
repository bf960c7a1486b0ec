// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/state_variable.hpp"

#include "dsp/signal/filter/sample.hpp"
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct StateVariable {
    static constexpr auto about =
        "Second-order filter with all its outputs at once, whose frequency may move fast (state variable, trapezoidal "
        "integration). A non-finite sample counts as 0.";

    In<Signal> in{"the signal"};
    Out<Signal> low{"what lies below the frequency"};
    Out<Signal> band{"what lies around it, with gain 1 there"};
    Out<Signal> high{"what lies above it"};
    Out<Signal> notch{"all but what lies around it: low + high"};
    Param frequency{"1 kHz", "0.01 Hz", "1 MHz", "corner or centre frequency"};
    Param q{"0.70710678", "0.05", "200", "gain of low and high at the frequency; centre over -3 dB width of the band"};

    void prepare(const Setup& setup) { rate_ = setup.rate(); }
    void process(const Tick& tick) noexcept {
        if (frequency != frequency_ || q != q_) {
            frequency_ = frequency;
            q_ = q;
            filter_.set(frequency_, rate_, q_);
        }
        for (int i = 0; i < tick.frames; ++i) {
            const auto y = filter_(signal::finite_or_zero(in[i]));
            low[i] = signal::to_sample(y.low);
            band[i] = signal::to_sample(y.band);
            high[i] = signal::to_sample(y.high);
            notch[i] = signal::to_sample(y.low + y.high);
        }
    }

private:
    signal::StateVariable filter_;
    double rate_ = 48000.0, frequency_ = 0.0, q_ = 0.0;
};

TACTUS_NODE(StateVariable, in, low, band, high, notch, frequency, q)

}  // namespace tactus::nodes
