// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "nodes/math/componentwise.hpp"

namespace tactus::nodes {

struct Subtract {
    static constexpr auto about = "Difference of two values of one type, component by component.";
    static constexpr UnitRule units = UnitRule::same;

    AnyIn a{"the value to subtract from", kinds::addable};
    AnyIn b{"what is subtracted, of the same type", kinds::addable};
    AnyOut out{"a - b"};

    void process(const Tick& tick) noexcept {
        for_each_component(a, b, out, tick, [](auto x, auto y) { return x - y; });
    }
};

TACTUS_NODE(Subtract, a, b, out)

}  // namespace tactus::nodes
