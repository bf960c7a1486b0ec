// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Inverse {
    static constexpr auto about = "The inverse of a pose: composed with it, the identity.";

    In<Pose> in{"the pose", "m"};
    Out<Pose> out{"its inverse", "m"};

    void process(const Tick&) noexcept { out = in->inverse(); }
};

TACTUS_NODE(Inverse, in, out)

}  // namespace tactus::nodes
