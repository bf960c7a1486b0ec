// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "nodes/math/componentwise.hpp"

#include <cmath>

namespace tactus::nodes {

struct Absolute {
    static constexpr auto about = "Absolute value of a number, or of each sample of a signal.";
    static constexpr UnitRule units = UnitRule::same;

    AnyIn in{"the value", kinds::number | kinds::signal};
    AnyOut out{"|in|"};

    void process(const Tick& tick) noexcept {
        for_each_component(in, out, tick, [](double x) { return std::abs(x); });
    }
};

TACTUS_NODE(Absolute, in, out)

}  // namespace tactus::nodes
