// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"

#include <algorithm>

namespace tactus::nodes {

struct SphereContact {
    static constexpr auto about =
        "Contact of a ball on the tool with a fixed ball: force = stiffness × depth, along the line of centres.";

    In<Pose> pose{"of the tool; its ball is centred at the origin", "m"};
    Out<Wrench> wrench{"on the tool, about its origin", "N, N m"};
    Out<double> penetration{"depth of the tool's ball in the fixed ball", "m"};
    Out<bool> in_contact{"the balls touch"};
    Vector centre{"0 mm, 0 mm, 0 mm", "of the fixed ball"};
    Param radius{"50 mm", "0.1 mm", "1 m", "of the fixed ball"};
    Param tool_radius{"5 mm", "0 mm", "1 m", "of the ball on the tool"};
    Param stiffness{"0.8 N/mm", "0 N/mm", "20 N/mm", "force per depth"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::still_ball, .at = centre, .radius = radius},
                {.kind = VisualKind::ball, .pose = "pose", .force = "wrench", .radius = tool_radius}};
    }

    void process(const Tick&) noexcept {
        const Vec3 from_centre = pose->position - centre.value;
        const double distance = glm::length(from_centre);
        const double depth = std::max(0.0, radius + tool_radius - distance);
        // The direction at the very centre is arbitrary. A force that fell to zero there would be taken for free space: an output
        // holds forces off from a hand that begins inside, by the force that it is asked for.
        const Vec3 normal = distance > 0.0 ? from_centre / distance : Vec3(0.0, 0.0, 1.0);
        wrench = {normal * (stiffness * depth), {}};
        penetration = depth;
        in_contact = depth > 0.0;
    }
};

TACTUS_NODE(SphereContact, pose, wrench, penetration, in_contact, centre, radius, tool_radius, stiffness)
TACTUS_VISUALS(SphereContact)

}  // namespace tactus::nodes
