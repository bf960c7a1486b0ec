// SPDX-License-Identifier: Apache-2.0
#include "dsp/guide/box.hpp"
#include "graph/node/visual.hpp"
#include "nodes/guide/guide_parameters.hpp"

namespace tactus::nodes {

struct BoxGuide {
    static constexpr auto about =
        "Keeps the hand inside of a box, or out of it through the nearest face. Within the box the force turns from "
        "face "
        "to face: where two are as near, it is that of neither." TACTUS_GUIDE_ABOUT;

    In<Pose> pose{"of the hand", "m"};
    In<Twist> twist{optional, "of the hand; open: no damping", "m/s, rad/s"};
    In<Pose> frame{optional, of_world, "the guide's frame; open: the world. A frame that moves does work on the hand",
                   "m"};
    Out<Wrench> wrench{"on the hand, about its origin", "N, N m"};
    Out<double> distance{"in the wall, from its nearest face; 0: no contact", "m"};
    Vector centre{"0 mm, 0 mm, 0 mm", "of the box"};
    Vector size{"100 mm, 100 mm, 100 mm", "along the axes of the frame"};
    Choice keep{{"inside", "outside"}, "where the hand may be"};
    GuideParameters guide;

    std::vector<Visual> visuals() const {
        return {
            {.kind = VisualKind::box, .hand = "pose", .force = "wrench", .frame = "frame", .at = centre, .size = size}};
    }

    void prepare(const Setup& setup) {
        if (!(size.value.x > 0.0 && size.value.y > 0.0 && size.value.z > 0.0))
            setup.fail("the three parts of 'size' must be above 0");
    }

    void process(const Tick&) noexcept {
        const GuidedHand hand(pose, twist, frame);
        wrench = Wrench{};
        if (!hand.is_known) return;
        const Vec3 at = hand.position - centre.value, half = 0.5 * size.value;
        Vec3 force(0.0);
        if (keep.index == 0) {
            const guide::WallContact wall = guide::outside_of(at, half);
            distance = wall.depth;
            force = guide.law().repel(wall.depth, wall.normal, hand.velocity);
        } else {
            distance = guide::inside_of(at, half).depth;
            const guide::RoundedContact wall = guide::rounded_inside_of(at, half);
            force = wall.share * guide.law().repel(wall.depth, wall.normal, hand.velocity);
        }
        wrench = {frame->orientation * force, {}};
    }
};

TACTUS_NODE(BoxGuide, pose, twist, frame, wrench, distance, centre, size, keep, guide)
TACTUS_VISUALS(BoxGuide)

}  // namespace tactus::nodes
