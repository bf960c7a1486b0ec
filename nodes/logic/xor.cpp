// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Xor {
    static constexpr auto about = "True while exactly one input is.";

    In<bool> a{"a bool"};
    In<bool> b{"a bool"};
    Out<bool> out{"either a or b, not both"};

    void process(const Tick&) noexcept { out = a != b; }
};

TACTUS_NODE(Xor, a, b, out)

}  // namespace tactus::nodes
