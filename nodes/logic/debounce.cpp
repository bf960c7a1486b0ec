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
        kept_s_ = 0.0;
    }
    void process(const Tick& tick) noexcept {
        kept_s_ = in == out.get() ? 0.0 : kept_s_ + tick.elapsed_seconds();
        if (in != out.get() && kept_s_ >= time) {
            out = in;
            kept_s_ = 0.0;
        }
    }

private:
    double kept_s_ = 0.0;
};

TACTUS_NODE(Debounce, in, out, time)

}  // namespace tactus::nodes
