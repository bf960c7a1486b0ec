// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::nodes {

struct Clock {
    static constexpr auto about = "True for one tick at regular times, the first time in the first tick.";

    Out<bool> out{"true in one tick of each period; in every tick when the period is shorter than one"};
    Out<double> phase{"share of the period that has passed, from 0 to 1"};
    Param period{"1 s", "1 ms", "1 h", "from one time to the next"};

    void prepare(const Setup&) {
        phase_ = 1.0;
        is_first_ = true;
    }
    void process(const Tick& tick) noexcept {
        if (!is_first_) phase_ += tick.elapsed_seconds() / period;
        is_first_ = false;
        // A period that is a whole number of ticks must not come one tick late by rounding.
        const bool is_due = phase_ >= 1.0 - rounding;
        if (is_due) phase_ = std::max(phase_ - std::floor(phase_ + rounding), 0.0);
        out = is_due;
        phase = phase_;
    }

private:
    static constexpr double rounding = 1e-9;
    double phase_ = 1.0;
    bool is_first_ = true;
};

TACTUS_NODE(Clock, out, phase, period)

}  // namespace tactus::nodes
