// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/rotation.hpp"
#include "graph/node/node.hpp"

#include <cmath>

namespace tactus::nodes {

struct Distance {
    static constexpr auto about = "Distance and angle between two poses, and the vector from one to the other.";

    In<Pose> from{"a pose", "m"};
    In<Pose> to{"a pose", "m"};
    Out<double> distance{"between both positions", "m"};
    Out<Vec3> offset{"from the first position to the second", "m"};
    Out<double> angle{"of the shortest rotation from one orientation to the other", "rad"};

    void process(const Tick&) noexcept {
        const Vec3 between = to->position - from->position;
        const Vec3 turn = rotation_between(from->orientation, to->orientation);
        offset = between;
        distance = std::hypot(between.x, between.y, between.z);
        angle = std::hypot(turn.x, turn.y, turn.z);
    }
};

TACTUS_NODE(Distance, from, to, distance, offset, angle)

}  // namespace tactus::nodes
