// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Edge {
    static constexpr auto about = "True for one tick when a bool changes.";

    In<bool> in{"a bool; before the first tick it counts as false"};
    Out<bool> out{"true in the tick of the change"};
    Choice on{{"rise", "fall", "both"}, "which change: false to true, true to false, or either"};

    void prepare(const Setup&) { was_ = false; }
    void process(const Tick&) noexcept {
        const bool rises = in && !was_, falls = was_ && !in;
        out = (rises && on.index != 1) || (falls && on.index != 0);
        was_ = in;
    }

private:
    bool was_ = false;
};

TACTUS_NODE(Edge, in, out, on)

}  // namespace tactus::nodes
