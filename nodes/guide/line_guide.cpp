// SPDX-License-Identifier: Apache-2.0
#include "graph/node/visual.hpp"
#include "nodes/guide/guide_parameters.hpp"

namespace tactus::nodes {

struct LineGuide {
    static constexpr auto about = "Pulls the hand to a line, along which it is free." TACTUS_GUIDE_ABOUT;

    In<Pose> pose{"of the hand", "m"};
    In<Twist> twist{optional, "of the hand; open: no damping", "m/s, rad/s"};
    In<Pose> frame{optional, of_world, "the guide's frame; open: the world. A frame that moves does work on the hand",
                   "m"};
    Out<Wrench> wrench{"on the hand, about its origin", "N, N m"};
    Out<double> distance{"from the line", "m"};
    Out<double> along{"of the nearest point, from the guide's point along its direction", "m"};
    Vector point{"0 mm, 0 mm, 0 mm", "where the line begins, or any point of an endless one"};
    Vector direction{"0, 1, 0", "of the line"};
    Param length{"0 mm", "0 mm", "10 m", "of the line; 0: endless in both directions"};
    Param reach{"0 mm", "0 mm", "1 m",
                "distance at which the pull has faded to nothing, as of a magnet; 0: it never ends"};
    GuideParameters guide;

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::line,
                 .hand = "pose",
                 .force = "wrench",
                 .frame = "frame",
                 .at = point,
                 .direction = unit_of(direction),
                 .length = length}};
    }

    void prepare(const Setup& setup) { direction_ = direction_of(setup, direction, "direction"); }

    void process(const Tick&) noexcept {
        const GuidedHand hand(pose, twist, frame);
        wrench = Wrench{};
        if (!hand.is_known) return;
        const double reached = glm::dot(hand.position - point.value, direction_);
        along = length > 0.0 ? std::clamp(reached, 0.0, +length) : reached;
        const Vec3 offset = point.value + direction_ * along.get() - hand.position;
        distance = glm::length(offset);
        const Vec3 across = hand.velocity - direction_ * glm::dot(hand.velocity, direction_);
        wrench = {frame->orientation * guide.law(reach).attract(offset, across), {}};
    }

private:
    Vec3 direction_{0.0, 1.0, 0.0};
};

TACTUS_NODE(LineGuide, pose, twist, frame, wrench, distance, along, point, direction, length, reach, guide)
TACTUS_VISUALS(LineGuide)

}  // namespace tactus::nodes
