// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::nodes {

struct Ramp {
    static constexpr auto about =
        "A number that goes from one value to another in a given time when a trigger becomes true, and stays there.";

    In<bool> trigger{"begins when it becomes true, also again from the start"};
    Out<double> out{"'from' before the first trigger, then on the way to 'to'"};
    Out<bool> done{"true once it has arrived"};
    Param from{"0", "-1e12", "1e12", "where it begins, in SI units"};
    Param to{"1", "-1e12", "1e12", "where it ends, in SI units"};
    Param time{"1 s", "0 s", "1 h", "for the way"};
    Choice shape{{"linear", "smooth"}, "smooth: half a cosine, which begins and ends gently"};

    void prepare(const Setup&) {
        out = from;
        done = was_ = has_begun_ = false;
        passed_ = 0;
    }
    void process(const Tick& tick) noexcept {
        if (trigger && !was_) {
            has_begun_ = true;
            passed_ = 0;
        } else if (has_begun_) {
            passed_ = std::min(passed_ + tick.elapsed, longest);
        }
        was_ = trigger;
        double share = 0.0;
        if (has_begun_) share = time > 0.0 ? std::min(seconds(passed_) / time, 1.0) : 1.0;
        done = share >= 1.0;
        if (shape.index == 1) share = 0.5 - 0.5 * std::cos(std::numbers::pi * share);
        out = from + share * (to - from);
    }

private:
    static constexpr Flicks longest = 3601 * flicks_per_second;
    Flicks passed_ = 0;
    bool was_ = false, has_begun_ = false;
};

TACTUS_NODE(Ramp, trigger, out, done, from, to, time, shape)

}  // namespace tactus::nodes
