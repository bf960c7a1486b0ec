// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct And {
    static constexpr auto about = "True while both inputs are.";

    In<bool> a{"a bool"};
    In<bool> b{"a bool"};
    Out<bool> out{"a and b"};

    void process(const Tick&) noexcept { out = a && b; }
};

TACTUS_NODE(And, a, b, out)

}  // namespace tactus::nodes
