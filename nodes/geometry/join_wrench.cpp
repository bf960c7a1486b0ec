// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct JoinWrench {
    static constexpr auto about = "A wrench of a force and a torque.";

    In<Vec3> force{optional, "force", "N"};
    In<Vec3> torque{optional, "torque about the origin of the pose that the wrench belongs to", "N m"};
    Out<Wrench> out{"the wrench", "N, N m"};

    void process(const Tick&) noexcept { out = {force, torque}; }
};

TACTUS_NODE(JoinWrench, force, torque, out)

}  // namespace tactus::nodes
