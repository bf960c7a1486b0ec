// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "nodes/math/componentwise.hpp"

namespace tactus::nodes {

struct Maximum {
    static constexpr auto about = "The larger of two numbers, or of two signals sample by sample.";
    static constexpr UnitRule units = UnitRule::same;

    AnyIn a{"the first value", kinds::number | kinds::signal};
    AnyIn b{"the second value, of the same type", kinds::number | kinds::signal};
    AnyOut out{"the larger one"};

    void process(const Tick& tick) noexcept {
        for_each_component(a, b, out, tick, [](double x, double y) { return x < y ? y : x; });
    }
};

TACTUS_NODE(Maximum, a, b, out)

}  // namespace tactus::nodes
