// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/rotation.hpp"
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct JoinPose {
    static constexpr auto about = "A pose of a position and a rotation vector.";

    In<Vec3> position{optional, "position", "m"};
    In<Vec3> rotation{optional, "orientation as rotation vector: the axis, as long as the angle", "rad"};
    Out<Pose> out{"the pose", "m"};

    void process(const Tick&) noexcept { out = {position, rotation_by(rotation)}; }
};

TACTUS_NODE(JoinPose, position, rotation, out)

}  // namespace tactus::nodes
