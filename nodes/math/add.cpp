// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "nodes/math/componentwise.hpp"

namespace tactus::nodes {

struct Add {
    static constexpr auto about =
        "Sum of two values of one type. Wrenches are added as they are: both must refer to one point; wrench_sum "
        "transports them.";
    static constexpr UnitRule units = UnitRule::same;

    AnyIn a{"the first value", kinds::addable};
    AnyIn b{"the second value, of the same type", kinds::addable};
    AnyOut out{"a + b"};

    void process(const Tick& tick) noexcept {
        for_each_component(a, b, out, tick, [](auto x, auto y) { return x + y; });
    }
};

TACTUS_NODE(Add, a, b, out)

}  // namespace tactus::nodes
