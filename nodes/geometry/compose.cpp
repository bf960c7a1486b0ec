// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Compose {
    static constexpr auto about =
        "One pose after another: a pose that is given in the frame of another, in the outer frame.";

    In<Pose> outer{"pose of the frame", "m"};
    In<Pose> inner{"pose within the frame", "m"};
    Out<Pose> out{"the inner pose, where the frame is", "m"};

    void process(const Tick&) noexcept { out = outer.get() * inner.get(); }
};

TACTUS_NODE(Compose, outer, inner, out)

}  // namespace tactus::nodes
