// SPDX-License-Identifier: Apache-2.0
#include "graph/node/visual.hpp"
#include "nodes/guide/guide_parameters.hpp"

namespace tactus::nodes {

struct PlaneGuide {
    static constexpr auto about = "A wall on one side of a plane, or a pull to the plane from both." TACTUS_GUIDE_ABOUT;

    In<Pose> pose{"of the hand", "m"};
    In<Twist> twist{optional, "of the hand; open: no damping", "m/s, rad/s"};
    In<Pose> frame{optional, of_world, "the guide's frame; open: the world. A frame that moves does work on the hand",
                   "m"};
    Out<Wrench> wrench{"on the hand, about its origin", "N, N m"};
    Out<double> distance{"above the plane, along its normal", "m"};
    Vector point{"0 mm, 0 mm, 0 mm", "any point of the plane"};
    Vector normal{"0, 0, 1", "to where the hand may be"};
    Choice kind{{"wall", "both"},
                "wall: pushes out below the plane, never pulls; both: pulls to the plane from both sides"};
    Param reach{"0 mm", "0 mm", "1 m",
                "of kind 'both': distance at which the pull has faded to nothing; 0: it never ends"};
    GuideParameters guide;

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::plane,
                 .hand = "pose",
                 .force = "wrench",
                 .frame = "frame",
                 .at = point,
                 .direction = unit_of(normal)}};
    }

    void prepare(const Setup& setup) { normal_ = direction_of(setup, normal, "normal"); }

    void process(const Tick&) noexcept {
        const GuidedHand hand(pose, twist, frame);
        wrench = Wrench{};
        if (!hand.is_known) return;
        const double above = glm::dot(hand.position - point.value, normal_);
        distance = above;
        const Vec3 force = kind.index == 0
                               ? guide.law().repel(-above, normal_, hand.velocity)
                               : guide.law(reach).attract(normal_ * -above, normal_ * glm::dot(hand.velocity, normal_));
        wrench = {frame->orientation * force, {}};
    }

private:
    Vec3 normal_{0.0, 0.0, 1.0};
};

TACTUS_NODE(PlaneGuide, pose, twist, frame, wrench, distance, point, normal, kind, reach, guide)
TACTUS_VISUALS(PlaneGuide)

}  // namespace tactus::nodes
