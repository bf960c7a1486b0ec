// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Counter {
    static constexpr auto about = "Counts how often a bool has become true.";

    In<bool> in{"counted when it becomes true"};
    In<bool> reset{optional, "true: the count is 0"};
    Out<double> count{"how often; with 'turn', from 0 to turn - 1 and from there to 0"};
    Param turn{discrete, "0", "0", "1e9", "number of counts after which the count is 0 again; 0: never"};

    void prepare(const Setup&) {
        was_ = false;
        count = 0.0;
    }
    void process(const Tick&) noexcept {
        double now = count.get() + (in && !was_ ? 1.0 : 0.0);
        if (reset || (turn >= 1.0 && now >= turn)) now = 0.0;
        was_ = in;
        count = now;
    }

private:
    bool was_ = false;
};

TACTUS_NODE(Counter, in, reset, count, turn)

}  // namespace tactus::nodes
