// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/sample.hpp"
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct ToNumber {
    static constexpr auto about =
        "A bool or a signal as a number: of a bool one of two values, of a signal the newest sample, for slower nodes.";
    static constexpr UnitRule units = UnitRule::same;

    AnyIn in{"the bool or signal", kinds::boolean | kinds::signal};
    Out<double> out{"the number"};
    Param if_true{"1", "-1e12", "1e12", "the number for true"};
    Param if_false{"0", "-1e12", "1e12", "the number for false"};

    void process(const Tick& tick) noexcept {
        if (in.type == &value::signal) {
            for (int i = 0; i < tick.frames; ++i) out[i] = signal::finite_or_zero(in.as<float>()[i]);
        } else {
            out = *in.as<bool>() ? if_true : if_false;
        }
    }
};

TACTUS_NODE(ToNumber, in, out, if_true, if_false)

}  // namespace tactus::nodes
