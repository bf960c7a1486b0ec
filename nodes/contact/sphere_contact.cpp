// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::nodes {

struct SphereContact {
    static constexpr auto about =
        "Contact of a ball on the tool with a fixed ball: force = stiffness × depth, along the line of centres. Within "
        "a "
        "quarter of the distance at which they touch, the force turns no faster than the hand moves.";

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

    void prepare(const Setup&) { has_side_ = false; }

    void process(const Tick&) noexcept {
        const Vec3 from_centre = pose->position - centre.value;
        const double distance = glm::length(from_centre), reach = radius + tool_radius;
        const double depth = std::max(0.0, reach - distance);
        // The direction at the very centre is arbitrary. A force that fell to zero there would be taken for free space: an output
        // holds forces off from a hand that begins inside, by the force that it is asked for.
        const Vec3 normal = distance > 0.0 ? from_centre / distance : Vec3(0.0, 0.0, 1.0);
        Vec3 force = normal * (stiffness * depth);
        if (depth > 0.0 && has_side_ && !follows(normal, 4.0 * glm::length(from_centre - last_) / reach))
            force = (side_ * reach - from_centre) * stiffness.value;
        else side_ = normal;
        has_side_ = depth > 0.0 || distance > 0.0;
        last_ = from_centre;
        wrench = {force, {}};
        penetration = depth;
        in_contact = depth > 0.0;
    }

private:
    /// The point of the surface to which the spring pulls is a god object that slides at most four times as fast as the hand moves: past
    /// the centre the nearest point is on the other side at once, and the force would jump. It only ever comes nearer to the
    /// hand, so the force gives no energy. Turns `side_` by at most `angle`, rad; true if it arrives at `normal`.
    bool follows(const Vec3& normal, double angle) noexcept {
        const double between = std::atan2(glm::length(glm::cross(side_, normal)), glm::dot(side_, normal));
        if (!(between > angle)) return true;
        Vec3 across = normal - side_ * glm::dot(side_, normal);
        // Opposite: any way round.
        if (!(glm::length(across) > 1e-9))
            across = glm::cross(side_, std::abs(side_.x) < 0.5 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0));
        side_ = glm::normalize(side_ * std::cos(angle) + glm::normalize(across) * std::sin(angle));
        return false;
    }

    Vec3 side_{0.0, 0.0, 1.0}, last_{0.0};
    bool has_side_ = false;
};

TACTUS_NODE(SphereContact, pose, wrench, penetration, in_contact, centre, radius, tool_radius, stiffness)
TACTUS_VISUALS(SphereContact)

}  // namespace tactus::nodes
