// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/one_pole.hpp"
#include "dsp/signal/filter/sample.hpp"
#include "graph/node/node.hpp"

#include <cmath>

namespace tactus::nodes {

struct Compressor {
    static constexpr auto about =
        "Makes loud parts of a signal less loud: above the threshold its level grows only by the ratio-th part, in dB "
        "(feed-forward, peak level with attack and release; Giannoulis, Massberg and Reiss 2012). A non-finite sample "
        "counts as 0.";

    In<Signal> in{"the signal"};
    Out<Signal> out{"the signal with less range"};
    Out<double> gain{"by which it is multiplied now, without 'makeup'"};
    Param threshold{"0.25", "1e-6", "1e6", "level above which it acts, in the unit of the signal"};
    Param ratio{"4", "1", "1000", "dB of input per dB of output above the threshold; large: a limiter"};
    Param attack{"5 ms", "0 ms", "10 s", "time constant of a rising level"};
    Param release{"50 ms", "0 ms", "10 s", "time constant of a falling level"};
    Param makeup{"1", "0", "1000", "factor of the output"};

    void prepare(const Setup& setup) {
        dt_ = seconds(setup.period);
        follower_ = {};
        gain = 1.0;
    }
    void process(const Tick& tick) noexcept {
        follower_.attack_share = signal::lag_share(attack, dt_);
        follower_.release_share = signal::lag_share(release, dt_);
        const double slope = 1.0 / ratio - 1.0;
        for (int i = 0; i < tick.frames; ++i) {
            const double x = signal::finite_or_zero(in[i]), level = follower_(x);
            gain[i] = level > threshold ? std::pow(level / threshold, slope) : 1.0;
            out[i] = signal::to_sample(makeup * gain[i] * x);
        }
    }

private:
    signal::EnvelopeFollower follower_;
    double dt_ = 0.0;
};

TACTUS_NODE(Compressor, in, out, gain, threshold, ratio, attack, release, makeup)

}  // namespace tactus::nodes
