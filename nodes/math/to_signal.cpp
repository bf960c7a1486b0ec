// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/sample.hpp"
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct ToSignal {
    static constexpr auto about =
        "A number as a signal. A wire 'as linear' glides from value to value, any other holds each one.";
    static constexpr UnitRule units = UnitRule::same;

    In<Ramp> in{"the number"};
    Out<Signal> out{"the number as samples"};

    void process(const Tick& tick) noexcept {
        for (int i = 0; i < tick.frames; ++i) out[i] = signal::to_sample(in[i]);
    }
};

TACTUS_NODE(ToSignal, in, out)

}  // namespace tactus::nodes
