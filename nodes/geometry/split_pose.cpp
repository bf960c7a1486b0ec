// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/rotation.hpp"
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct SplitPose {
    static constexpr auto about = "Position of a pose, and its orientation as rotation vector.";

    In<Pose> in{"the pose", "m"};
    Out<Vec3> position{"position", "m"};
    Out<Vec3> rotation{"orientation as rotation vector: the axis, as long as the angle", "rad"};

    void process(const Tick&) noexcept {
        position = in->position;
        rotation = rotation_between(Quat(1.0, 0.0, 0.0, 0.0), in->orientation);
    }
};

TACTUS_NODE(SplitPose, in, position, rotation)

}  // namespace tactus::nodes
