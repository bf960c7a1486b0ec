// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Debounce {
    static constexpr auto about = "Follows a bool when it has kept its value for a time.";

    In<bool> in{"a bool that may flicker"};
    Out<bool> out{"the value that lasts"};
    Param time{"20 ms", "0 ms", "10 s", "for how long the input must keep a new value"};

    void prepare(const Setup&) {
        out = false;
        kept_ = 0;
    }
    void process(const Tick& tick) noexcept {
        if (in == out.get()) {
            kept_ = 0;
            return;
        }
        // Nobody saw the value in ticks that were left out: its first tick counts as one.
        kept_ += kept_ == 0 ? tick.period : tick.elapsed;
        if (seconds(kept_) < time) return;
        out = in;
        kept_ = 0;
    }

private:
    Flicks kept_ = 0;
};

TACTUS_NODE(Debounce, in, out, time)

}  // namespace tactus::nodes
