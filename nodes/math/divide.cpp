// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "nodes/math/componentwise.hpp"

#include <cmath>

namespace tactus::nodes {

struct Divide {
    static constexpr auto about =
        "Quotient of two numbers or two signals; 0 where the divisor is 0 or the quotient is not finite.";
    static constexpr UnitRule units = UnitRule::quotient;
    static constexpr bool shapes_values = true;

    AnyIn a{"the dividend", kinds::number | kinds::signal};
    AnyIn b{"the divisor, of the same type", kinds::number | kinds::signal};
    AnyOut out{"a / b, or 0 where that is not finite"};

    void process(const Tick& tick) noexcept {
        for_each_component(a, b, out, tick, [](double x, double y) {
            const double quotient = x / y;
            return std::isfinite(quotient) ? quotient : 0.0;
        });
    }
};

TACTUS_NODE(Divide, a, b, out)

}  // namespace tactus::nodes
