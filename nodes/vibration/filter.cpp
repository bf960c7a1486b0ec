// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/biquad_block.hpp"
#include "dsp/signal/filter/biquad_shelves.hpp"
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Filter {
    static constexpr auto about =
        "Second-order filter (biquad). A non-finite sample counts as 0; frequencies above half the rate act as just "
        "below.";
    static constexpr UnitRule units = UnitRule::same;

    In<Signal> in{"the signal"};
    Out<Signal> out{"the filtered signal"};
    Choice kind{{"lowpass", "highpass", "bandpass", "notch", "peak", "low_shelf", "high_shelf", "allpass"},
                "filter type"};
    Param frequency{"1 kHz", "0.1 Hz", "1 MHz", "corner frequency, or centre frequency of bandpass, notch and peak"};
    Param q{"0.70710678", "0.05", "200",
            "lowpass, highpass: gain at the corner; bandpass, notch: centre frequency divided by the -3 dB bandwidth; "
            "peak: by that of half its gain in dB; shelves: steepness"};
    Param boost{"2", "0.001", "1000", "peak: gain at the centre; shelves: gain on their side; a factor"};

    void prepare(const Setup& setup) { rate_ = setup.rate(); }

    void process(const Tick& tick) noexcept {
        if (frequency != frequency_ || q != q_ || boost != boost_) design();
        section_.run(&in[0], &out[0], tick.frames);
    }

private:
    void design() noexcept {
        frequency_ = frequency;
        q_ = q;
        boost_ = boost;
        section_.coefficients = [this] {
            switch (kind.index) {
                case 0: return signal::lowpass(frequency_, rate_, q_);
                case 1: return signal::highpass(frequency_, rate_, q_);
                case 2: return signal::bandpass(frequency_, rate_, q_);
                case 3: return signal::notch(frequency_, rate_, q_);
                case 4: return signal::peak(frequency_, rate_, q_, boost_);
                case 5: return signal::low_shelf(frequency_, rate_, q_, boost_);
                case 6: return signal::high_shelf(frequency_, rate_, q_, boost_);
                default: return signal::allpass(frequency_, rate_, q_);
            }
        }();
    }

    signal::BlockBiquad section_;
    double rate_ = 48000.0, frequency_ = 0.0, q_ = 0.0, boost_ = 0.0;
};

TACTUS_NODE(Filter, in, out, kind, frequency, q, boost)

}  // namespace tactus::nodes
