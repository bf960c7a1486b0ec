// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Not {
    static constexpr auto about = "True while the input is false.";

    In<bool> in{"a bool"};
    Out<bool> out{"not in"};

    void process(const Tick&) noexcept { out = !in; }
};

TACTUS_NODE(Not, in, out)

}  // namespace tactus::nodes
