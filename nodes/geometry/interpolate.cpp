// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Interpolate {
    static constexpr auto about =
        "Between two values of one type: straight for numbers, vectors, twists and wrenches, along the shortest "
        "rotation "
        "for poses.";
    static constexpr UnitRule units = UnitRule::same;

    AnyIn a{"the value at share 0", types};
    AnyIn b{"the value at share 1, of the same type", types};
    AnyOut out{"a + share × (b - a)"};
    Param share{"0.5", "0", "1", "how far from a to b"};

    void process(const Tick&) noexcept { out.type->interpolate(a.data, b.data, share, out.data); }

private:
    static constexpr ValueKinds types = kinds::number | kinds::vector | kinds::pose | kinds::twist | kinds::wrench;
};

TACTUS_NODE(Interpolate, a, b, out, share)

}  // namespace tactus::nodes
