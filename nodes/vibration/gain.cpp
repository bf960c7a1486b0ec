// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Gain {
    static constexpr auto about = "Multiplies a signal by a factor.";

    In<Signal> in{"the signal"};
    Out<Signal> out{"factor × in"};
    Param factor{"1", "-1000", "1000", "gain"};

    void process(const Tick& tick) noexcept {
        const auto f = static_cast<float>(factor);
        for (int i = 0; i < tick.frames; ++i) out[i] = f * in[i];
    }
};

TACTUS_NODE(Gain, in, out, factor)

}  // namespace tactus::nodes
