// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/one_pole.hpp"
#include "dsp/signal/filter/sample.hpp"
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Envelope {
    static constexpr auto about = "Envelope follower: the smoothed absolute value of a signal.";
    static constexpr UnitRule units = UnitRule::same;

    In<Signal> in{"the signal"};
    Out<Signal> out{"the envelope"};
    Out<double> level{"the envelope as a number, for slower nodes"};
    Param attack{"5 ms", "0 ms", "10 s", "time constant of the rise"};
    Param release{"50 ms", "0 ms", "10 s", "time constant of the fall"};

    void prepare(const Setup& setup) { dt_ = seconds(setup.period); }

    void process(const Tick& tick) noexcept {
        follower_.attack_share = signal::lag_share(attack, dt_);
        follower_.release_share = signal::lag_share(release, dt_);
        for (int i = 0; i < tick.frames; ++i) {
            level[i] = follower_(signal::finite_or_zero(in[i]));
            out[i] = static_cast<float>(level[i]);
        }
    }

private:
    signal::EnvelopeFollower follower_;
    double dt_ = 0.0;
};

TACTUS_NODE(Envelope, in, out, level, attack, release)

}  // namespace tactus::nodes
