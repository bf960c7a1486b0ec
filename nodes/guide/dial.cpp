// SPDX-License-Identifier: Apache-2.0
#include "dsp/guide/twist_angle.hpp"
#include "graph/node/visual.hpp"
#include "nodes/guide/guide_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::nodes {

struct Dial {
    static constexpr auto about =
        "A knob with notches: torque = -stiffness / notches × sin(notches × angle) about an axis of the frame. Bounded "
        "by "
        "'max_torque'. Passive but for sampling, as the other guides, unless the bound shortens the torque on a hand "
        "that is "
        "tilted against the axis.";

    In<Pose> pose{"of the hand", "m"};
    In<Twist> twist{optional, "of the hand; open: no damping", "m/s, rad/s"};
    In<Pose> frame{optional, of_world, "the knob's frame; open: the world. A frame that turns does work on the hand",
                   "m"};
    Out<Wrench> wrench{"on the hand, about its origin", "N, N m"};
    Out<double> angle{"of the hand about the axis", "rad"};
    Out<double> notch{"number of the nearest notch, from 0 on"};
    Vector axis{"0, 0, 1", "about which the knob turns"};
    Param notches{discrete, "12", "1", "360", "of one turn"};
    Param stiffness{"0.5 N m/rad", "0 N m/rad", "20 N m/rad", "torque per angle in a notch"};
    Param damping{"1e-3 N m s/rad", "0 N m s/rad", "1 N m s/rad",
                  "torque per angular velocity, where 'twist' is wired"};
    Param max_torque{"0.1 N m", "0 N m", "5 N m", "largest torque of the knob"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::line,
                 .hand = "pose",
                 .force = "wrench",
                 .frame = "frame",
                 .direction = unit_of(axis),
                 .length = 50e-3}};
    }

    void prepare(const Setup& setup) { axis_ = direction_of(setup, axis, "axis"); }

    void process(const Tick&) noexcept {
        wrench = Wrench{};
        if (!is_valid(pose.get()) || !is_valid(frame.get())) return;
        const Quat back = glm::conjugate(frame->orientation);
        const guide::TwistAngle turned = guide::twist_angle(back * pose->orientation, axis_);
        angle = turned.angle;
        const double count = std::round(notches);
        const double turns = count * turned.angle / (2.0 * std::numbers::pi), nearest = std::round(turns);
        notch = nearest < 0.0 ? nearest + count : nearest;
        const double torque = -stiffness / count * std::sin(2.0 * std::numbers::pi * (turns - nearest));
        Vec3 spring = turned.gradient * std::clamp(torque, -max_torque, +max_torque);
        // A hand that is tilted far would turn the angle with little motion.
        const double length = glm::length(spring);
        if (length > max_torque) spring *= max_torque / length;
        Vec3 damper(0.0);
        if (twist.connected && is_finite(twist->angular) && glm::length(twist->angular) < 1e6)
            damper = axis_ * (-damping * glm::dot(back * twist->angular, axis_));
        wrench = {{}, frame->orientation * guide::limited_sum(spring, damper, max_torque)};
    }

private:
    Vec3 axis_{0.0, 0.0, 1.0};
};

TACTUS_NODE(Dial, pose, twist, frame, wrench, angle, notch, axis, notches, stiffness, damping, max_torque)
TACTUS_VISUALS(Dial)

}  // namespace tactus::nodes
