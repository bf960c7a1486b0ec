// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "nodes/logic/values.hpp"

namespace tactus::nodes {

struct Select {
    static constexpr auto about =
        "One of two values of one type. It changes from one to the other at once: on a force or a sound, slew or a "
        "gain "
        "behind it keeps that from being felt.";
    static constexpr UnitRule units = UnitRule::same;

    In<bool> which{"false: a, true: b"};
    AnyIn a{"the value while 'which' is false", kinds::plain};
    AnyIn b{"the value while 'which' is true, of the same type", kinds::plain};
    AnyOut out{"the selected value"};

    void process(const Tick& tick) noexcept { copy_value(which ? b.data : a.data, out, tick); }
};

TACTUS_NODE(Select, which, a, b, out)

}  // namespace tactus::nodes
