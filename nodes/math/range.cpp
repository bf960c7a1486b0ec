// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <algorithm>

namespace tactus::nodes {

struct Range {
    static constexpr auto about =
        "Maps a number from one range to another along a straight line; outside the range it stays at the ends. SI.";

    In<double> in{"a number"};
    Out<double> out{"in_low gives out_low, in_high gives out_high"};
    Param in_low{"0", "-1e12", "1e12", "one end of what comes in"};
    Param in_high{"1", "-1e12", "1e12", "the other end"};
    Param out_low{"0", "-1e12", "1e12", "what in_low gives"};
    Param out_high{"1", "-1e12", "1e12", "what in_high gives"};

    void prepare(const Setup&) { out = map(0.0); }
    void process(const Tick&) noexcept { out = map(in); }

private:
    double map(double x) const noexcept {
        if (!(x == x)) return out_low;
        // Ends that coincide make a step.
        if (in_high == in_low) return x < in_low ? out_low : out_high;
        const double t = std::clamp((x - in_low) / (in_high - in_low), 0.0, 1.0);
        return out_low + t * (out_high - out_low);
    }
};

TACTUS_NODE(Range, in, out, in_low, in_high, out_low, out_high)

}  // namespace tactus::nodes
