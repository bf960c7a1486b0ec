// SPDX-License-Identifier: Apache-2.0
#include "graph/node/visual.hpp"
#include "nodes/guide/guide_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::nodes {

struct Detents {
    static constexpr auto about =
        "Notches along an axis at equal distances: force = -stiffness × spacing / 2π × sin(2π x / "
        "spacing)." TACTUS_GUIDE_ABOUT;

    In<Pose> pose{"of the hand", "m"};
    In<Twist> twist{optional, "of the hand; open: no damping", "m/s, rad/s"};
    In<Pose> frame{optional, of_world, "the guide's frame; open: the world. A frame that moves does work on the hand",
                   "m"};
    Out<Wrench> wrench{"on the hand, about its origin", "N, N m"};
    Out<double> notch{"number of the nearest notch; 0 is at 'first'"};
    Vector axis{"1, 0, 0", "along which the notches lie"};
    Param first{"0 mm", "-1 m", "1 m", "place of one notch along the axis"};
    Param spacing{"6 mm", "0.1 mm", "1 m", "from notch to notch"};
    GuideParameters guide;

    std::vector<Visual> visuals() const {
        std::vector<Visual> all{{.kind = VisualKind::line,
                                 .hand = "pose",
                                 .force = "wrench",
                                 .frame = "frame",
                                 .at = first.value * unit_of(axis),
                                 .direction = unit_of(axis)}};
        for (int n = -5; n <= 5; ++n)
            all.push_back(
                {.kind = VisualKind::point, .frame = "frame", .at = (first.value + n * spacing.value) * unit_of(axis)});
        return all;
    }

    void prepare(const Setup& setup) { axis_ = direction_of(setup, axis, "axis"); }

    void process(const Tick&) noexcept {
        const GuidedHand hand(pose, twist, frame);
        wrench = Wrench{};
        if (!hand.is_known) return;
        const double turns = (glm::dot(hand.position, axis_) - first) / spacing;
        notch = std::round(turns);
        const guide::GuideLaw law = guide.law();
        const double peak = law.stiffness * spacing / (2.0 * std::numbers::pi);
        const double force = -peak * std::sin(2.0 * std::numbers::pi * (turns - notch.get()));
        const Vec3 spring = axis_ * std::clamp(force, -law.max_force, law.max_force);
        const Vec3 damper = axis_ * (-law.damping * glm::dot(hand.velocity, axis_));
        wrench = {frame->orientation * guide::limited_sum(spring, damper, law.max_force), {}};
    }

private:
    Vec3 axis_{1.0, 0.0, 0.0};
};

TACTUS_NODE(Detents, pose, twist, frame, wrench, notch, axis, first, spacing, guide)
TACTUS_VISUALS(Detents)

}  // namespace tactus::nodes
