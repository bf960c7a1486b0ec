// SPDX-License-Identifier: Apache-2.0
#include "graph/node/visual.hpp"
#include "nodes/guide/guide_parameters.hpp"

namespace tactus::nodes {

struct PointGuide {
    static constexpr auto about = "Pulls the hand to a point." TACTUS_GUIDE_ABOUT;

    In<Pose> pose{"of the hand", "m"};
    In<Twist> twist{optional, "of the hand; open: no damping", "m/s, rad/s"};
    In<Pose> frame{optional, of_world, "the guide's frame; open: the world. A frame that moves does work on the hand",
                   "m"};
    Out<Wrench> wrench{"on the hand, about its origin", "N, N m"};
    Out<double> distance{"from the point", "m"};
    Vector point{"0 mm, 0 mm, 0 mm", "where it pulls to"};
    Param reach{"0 mm", "0 mm", "1 m",
                "distance at which the pull has faded to nothing, as of a magnet; 0: it never ends"};
    GuideParameters guide;

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::point, .hand = "pose", .force = "wrench", .frame = "frame", .at = point}};
    }

    void process(const Tick&) noexcept {
        const GuidedHand hand(pose, twist, frame);
        wrench = Wrench{};
        if (!hand.is_known) return;
        const Vec3 offset = point.value - hand.position;
        distance = glm::length(offset);
        wrench = {frame->orientation * guide.law(reach).attract(offset, hand.velocity), {}};
    }
};

TACTUS_NODE(PointGuide, pose, twist, frame, wrench, distance, point, reach, guide)
TACTUS_VISUALS(PointGuide)

}  // namespace tactus::nodes
