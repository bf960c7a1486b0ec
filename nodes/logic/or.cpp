// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Or {
    static constexpr auto about = "True while at least one input is.";

    In<bool> a{"a bool"};
    In<bool> b{"a bool"};
    Out<bool> out{"a or b"};

    void process(const Tick&) noexcept { out = a || b; }
};

TACTUS_NODE(Or, a, b, out)

}  // namespace tactus::nodes
