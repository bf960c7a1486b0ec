// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/placement.hpp"
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct DeviceWrench {
    static constexpr auto about =
        "Transforms a wrench on the tool to the hand: device axes, torque about the handle, equal power on both sides.";

    In<Wrench> wrench{"on the tool, about its origin, scene axes", "N, N m"};
    In<Pose> tool{"pose of the tool in the scene: workspace.pose", "m"};
    In<Pose> frame{"device axes at the handle, in the scene: workspace.frame", "m"};
    Out<Wrench> on_hand{"about the handle, device frame", "N, N m"};
    Param scale{"1", "0.01", "100", "scale of the workspace; connect workspace.force_scale"};

    void process(const Tick&) noexcept { on_hand = coupling::wrench_on_hand(wrench, tool->position, frame, scale); }
};

TACTUS_NODE(DeviceWrench, wrench, tool, frame, on_hand, scale)

}  // namespace tactus::nodes
