// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct SplitTwist {
    static constexpr auto about = "Velocity and angular velocity of a twist.";

    In<Twist> in{"the twist", "m/s, rad/s"};
    Out<Vec3> linear{"velocity", "m/s"};
    Out<Vec3> angular{"angular velocity", "rad/s"};

    void process(const Tick&) noexcept {
        linear = in->linear;
        angular = in->angular;
    }
};

TACTUS_NODE(SplitTwist, in, linear, angular)

}  // namespace tactus::nodes
