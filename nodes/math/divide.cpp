// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "nodes/math/componentwise.hpp"

namespace tactus::nodes {

struct Divide {
    static constexpr auto about = "Quotient of two numbers or two signals; 0 where the divisor is 0.";
    static constexpr UnitRule units = UnitRule::quotient;
    static constexpr bool shapes_values = true;

    AnyIn a{"the dividend", kinds::number | kinds::signal};
    AnyIn b{"the divisor, of the same type", kinds::number | kinds::signal};
    AnyOut out{"a / b, or 0 where b is 0"};

    void process(const Tick& tick) noexcept {
        for_each_component(a, b, out, tick, [](double x, double y) { return y == 0.0 ? 0.0 : x / y; });
    }
};

TACTUS_NODE(Divide, a, b, out)

}  // namespace tactus::nodes
