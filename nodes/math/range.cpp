// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <algorithm>

namespace tactus::nodes {

struct Range {
    static constexpr auto about =
        "Maps a number linearly from one range to another and clamps it to the range. SI units.";

    In<double> in{"the number to map"};
    Out<double> out{"the mapped number: in_low gives out_low, in_high gives out_high"};
    Param in_low{"0", "-1e12", "1e12", "one end of the input range"};
    Param in_high{"1", "-1e12", "1e12", "the other end of the input range"};
    Param out_low{"0", "-1e12", "1e12", "output for in_low"};
    Param out_high{"1", "-1e12", "1e12", "output for in_high"};

    void prepare(const Setup&) { out = map(0.0); }
    void process(const Tick&) noexcept { out = map(in); }

private:
    double map(double x) const noexcept {
        if (!(x == x)) return out_low;
        // An input range without length gives a step.
        if (in_high == in_low) return x < in_low ? out_low : out_high;
        const double t = std::clamp((x - in_low) / (in_high - in_low), 0.0, 1.0);
        return out_low + t * (out_high - out_low);
    }
};

TACTUS_NODE(Range, in, out, in_low, in_high, out_low, out_high)

}  // namespace tactus::nodes
