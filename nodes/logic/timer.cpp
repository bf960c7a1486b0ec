// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Timer {
    static constexpr auto about = "A stopwatch: for how long a bool has been true, in all.";

    In<bool> run{"true: the time runs"};
    In<bool> reset{optional, "true: the time is 0"};
    Out<double> time{"for how long", "s"};

    void prepare(const Setup&) {
        time = 0.0;
        ticks_ = 0;
    }
    void process(const Tick& tick) noexcept {
        // Whole units of time: a sum of seconds would drift.
        ticks_ = reset ? 0 : ticks_ + (run ? tick.elapsed : 0);
        time = seconds(ticks_);
    }

private:
    Flicks ticks_ = 0;
};

TACTUS_NODE(Timer, run, reset, time)

}  // namespace tactus::nodes
