// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "nodes/logic/values.hpp"

namespace tactus::nodes {

struct Gate {
    static constexpr auto about =
        "Lets a value through while it is open; closed, it gives zero, the identity, false or silence. It changes at "
        "once.";
    static constexpr UnitRule units = UnitRule::same;

    In<bool> open{"lets the value through"};
    AnyIn in{"the value", kinds::plain};
    AnyOut out{"the value, or nothing"};

    void process(const Tick& tick) noexcept {
        if (open) copy_value(in.data, out, tick);
        else put_default(out, tick);
    }
};

TACTUS_NODE(Gate, open, in, out)

}  // namespace tactus::nodes
