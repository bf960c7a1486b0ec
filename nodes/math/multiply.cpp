// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "nodes/math/componentwise.hpp"

namespace tactus::nodes {

struct Multiply {
    static constexpr auto about =
        "Product of two numbers or two signals. Vectors, twists and wrenches are scaled by gain.";
    static constexpr UnitRule units = UnitRule::product;
    static constexpr bool shapes_values = true;

    AnyIn a{"the first factor", kinds::number | kinds::signal};
    AnyIn b{"the second factor, of the same type", kinds::number | kinds::signal};
    AnyOut out{"a × b"};

    void process(const Tick& tick) noexcept {
        for_each_component(a, b, out, tick, [](auto x, auto y) { return x * y; });
    }
};

TACTUS_NODE(Multiply, a, b, out)

}  // namespace tactus::nodes
