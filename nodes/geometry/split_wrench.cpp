// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct SplitWrench {
    static constexpr auto about = "Force and torque of a wrench.";

    In<Wrench> in{"the wrench", "N, N m"};
    Out<Vec3> force{"force", "N"};
    Out<Vec3> torque{"torque about the origin of the pose that the wrench belongs to", "N m"};

    void process(const Tick&) noexcept {
        force = in->force;
        torque = in->torque;
    }
};

TACTUS_NODE(SplitWrench, in, force, torque)

}  // namespace tactus::nodes
