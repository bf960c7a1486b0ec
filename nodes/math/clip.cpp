// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "nodes/math/componentwise.hpp"

#include <algorithm>

namespace tactus::nodes {

struct Clip {
    static constexpr auto about = "Limits a number, or each sample of a signal, to a range. SI units.";
    static constexpr UnitRule units = UnitRule::same;

    AnyIn in{"the value", kinds::number | kinds::signal};
    AnyOut out{"the value within the range"};
    Param low{"-1", "-1e12", "1e12", "least value"};
    Param high{"1", "-1e12", "1e12", "greatest value; where it is below 'low', the output is 'high'"};

    void process(const Tick& tick) noexcept {
        const double least = low, most = high;
        // NaN becomes the least value.
        for_each_component(in, out, tick, [=](double x) { return std::min(x > least ? x : least, most); });
    }
};

TACTUS_NODE(Clip, in, out, low, high)

}  // namespace tactus::nodes
