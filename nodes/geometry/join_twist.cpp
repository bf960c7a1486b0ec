// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct JoinTwist {
    static constexpr auto about = "A twist of a velocity and an angular velocity.";

    In<Vec3> linear{optional, "velocity", "m/s"};
    In<Vec3> angular{optional, "angular velocity", "rad/s"};
    Out<Twist> out{"the twist", "m/s, rad/s"};

    void process(const Tick&) noexcept { out = {linear, angular}; }
};

TACTUS_NODE(JoinTwist, linear, angular, out)

}  // namespace tactus::nodes
