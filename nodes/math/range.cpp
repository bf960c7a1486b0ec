// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "nodes/math/componentwise.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::nodes {

struct Range {
    static constexpr auto about =
        "Maps a number, or each sample of a signal, from one range to another and clamps it to the range. SI units.";
    static constexpr bool shapes_values = true;

    AnyIn in{"the value to map", kinds::number | kinds::signal};
    AnyOut out{"the mapped value: in_low gives out_low, in_high gives out_high"};
    Param in_low{"0", "-1e12", "1e12", "one end of the input range"};
    Param in_high{"1", "-1e12", "1e12", "the other end of the input range"};
    Param out_low{"0", "-1e12", "1e12", "output for in_low"};
    Param out_high{"1", "-1e12", "1e12", "output for in_high"};
    Choice shape{
        {"linear", "exponential"},
        "linear: a straight line; exponential: equal steps give equal ratios, as for frequencies, where out_low and "
        "out_high have one sign"};

    void prepare(const Setup& setup) {
        is_exponential_ = shape.is("exponential");
        if (is_exponential_ && !(out_low * out_high > 0.0))
            setup.fail("an exponential range needs out_low and out_high of one sign, neither of them 0");
        if (out.type == &value::number) *out.as<double>() = map(0.0);
    }
    std::vector<PortSlope> slopes() const {
        const double width = std::abs(in_high - in_low), change = std::abs(out_high - out_low);
        if (!shape.is("exponential")) return {{"in", change / width}};
        const double ratio = std::log(std::abs(out_high / out_low));
        return {{"in", std::abs(ratio) * std::max(std::abs(out_low), std::abs(out_high)) / width}};
    }
    void process(const Tick& tick) noexcept {
        for_each_component(in, out, tick, [this](double x) { return map(x); });
    }

private:
    double map(double x) const noexcept {
        if (!(x == x)) return out_low;
        // An input range without length gives a step.
        if (in_high == in_low) return x < in_low ? out_low : out_high;
        const double t = std::clamp((x - in_low) / (in_high - in_low), 0.0, 1.0);
        // A live change may take one end to the other sign: a straight line then.
        if (is_exponential_ && out_low * out_high > 0.0) return out_low * std::pow(out_high / out_low, t);
        return out_low + t * (out_high - out_low);
    }

    bool is_exponential_ = false;
};

TACTUS_NODE(Range, in, out, in_low, in_high, out_low, out_high, shape)

}  // namespace tactus::nodes
