// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "nodes/math/componentwise.hpp"

namespace tactus::nodes {

struct Negate {
    static constexpr auto about = "The opposite of a value, component by component.";
    static constexpr UnitRule units = UnitRule::same;

    AnyIn in{"the value", kinds::addable};
    AnyOut out{"-in"};

    void process(const Tick& tick) noexcept {
        for_each_component(in, out, tick, [](double x) { return -x; });
    }
};

TACTUS_NODE(Negate, in, out)

}  // namespace tactus::nodes
