// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Latch {
    static constexpr auto about = "Remembers that something was true, until it is reset.";

    In<bool> set{"true: the output becomes true"};
    In<bool> reset{optional, "true: the output becomes false; it wins over 'set'"};
    Out<bool> out{"the memory"};

    void prepare(const Setup&) { out = false; }
    void process(const Tick&) noexcept { out = !reset && (set || out.get()); }
};

TACTUS_NODE(Latch, set, reset, out)

}  // namespace tactus::nodes
