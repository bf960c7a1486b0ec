// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "nodes/math/componentwise.hpp"

#include <cmath>

namespace tactus::nodes {

struct Wrap {
    static constexpr auto about =
        "Brings a number, or each sample of a signal, into a range by adding or subtracting whole lengths of it, as an "
        "angle into one turn. SI units.";
    static constexpr UnitRule units = UnitRule::same;

    AnyIn in{"the value", kinds::number | kinds::signal};
    AnyOut out{"in + k × (high - low), at least 'low' and below 'high'; 'low' where the range has no length"};
    Param low{"0", "-1e12", "1e12", "least value"};
    Param high{"1", "-1e12", "1e12", "the end of the range, which is not reached"};

    void process(const Tick& tick) noexcept {
        const double least = low, length = high - low;
        const bool is_signal = out.type == &value::signal;
        for_each_component(in, out, tick, [=](double x) {
            if (!(length > 0.0) || !std::isfinite(x)) return least;
            const double wrapped = x - length * std::floor((x - least) / length);
            // Rounding may end at the border, or outside for a large x.
            if (!(wrapped >= least && wrapped < least + length)) return least;
            // As a float it may round up to the end.
            return is_signal && static_cast<double>(static_cast<float>(wrapped)) >= least + length ? least : wrapped;
        });
    }
};

TACTUS_NODE(Wrap, in, out, low, high)

}  // namespace tactus::nodes
