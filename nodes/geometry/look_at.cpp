// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace tactus::nodes {

struct LookAt {
    static constexpr auto about =
        "A pose at one position whose z axis points to another. Its y axis is as near to 'up' as it can be; where both "
        "positions meet, or 'up' lies along the axis, the last orientation stays.";

    In<Vec3> from{"where the pose is", "m"};
    In<Vec3> to{"what its z axis points to", "m"};
    Out<Pose> out{"the pose", "m"};
    Vector up{"0, 0, 1", "direction, without unit"};

    void process(const Tick&) noexcept {
        out.get().position = from;
        const Vec3 z = unit(to.get() - from.get()), x = unit(glm::cross(up.value, z));
        if (z == Vec3(0.0) || x == Vec3(0.0)) return;
        out.get().orientation = glm::normalize(glm::quat_cast(Mat3(x, glm::cross(z, x), z)));
    }

private:
    static Vec3 unit(const Vec3& v) noexcept {
        const double length = std::hypot(v.x, v.y, v.z);
        return length > 1e-12 && std::isfinite(length) ? v / length : Vec3(0.0);
    }
};

TACTUS_NODE(LookAt, from, to, out, up)

}  // namespace tactus::nodes
