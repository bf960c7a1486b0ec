// SPDX-License-Identifier: Apache-2.0
#include "dsp/simulate/gripper/held_weight.hpp"

#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::nodes {

struct HeldWeight {
    static constexpr auto about =
        "A weight on a table below the hand. A firm grip lifts it and the hand feels its weight; with a weak grip it "
        "slides out of the fingers.";

    In<Pose> hand{"in the device frame", "m"};
    In<Twist> hand_twist{optional, "velocity of the hand", "m/s, rad/s"};
    In<double> grip_force{"with which each finger presses", "N"};
    Out<Wrench> wrench{"on the hand", "N, N m"};
    Out<double> height{"of the weight above the table", "m"};
    Out<bool> held{"the fingers grip the weight"};
    Out<bool> slides{"the weight slides through the fingers"};
    Param mass{"200 g", "20 g", "5 kg", "of the weight"};
    Param friction{"0.6", "0", "5", "between finger and weight"};
    Param stiffness{internal, "0.6 N/mm", "0 N/mm", "5 N/mm", "of the grip"};
    Param damping{"8 N s/m", "0 N s/m", "50 N s/m", "of the grip"};
    Param threshold{"0.3 N", "0 N", "100 N", "the fingers grip above it"};

    std::vector<Visual> visuals() const { return {{.kind = VisualKind::weight, .value = "height", .hand = "hand"}}; }

    void prepare(const Setup&) {
        wrench = Wrench{};
        height = 0.0;
    }

    void process(const Tick& tick) noexcept {
        const double dt = seconds(tick.period);
        const bool good = is_finite(hand->position) && is_finite(hand_twist->linear) &&
                          std::isfinite(grip_force.get()) && glm::length(hand->position) < 10.0 &&
                          glm::length(hand_twist->linear) < 100.0;
        if (good) {
            hand_ = hand->position;
            speed_ = hand_twist.connected ? hand_twist->linear : Vec3(0.0);
        }
        const double press = good ? std::clamp(grip_force.get() - threshold, 0.0, 1000.0) : 0.0;
        const simulate::WeightSettings settings{mass, friction, stiffness, damping, 9.81, 0.0};
        // A step small enough for the lightest weight in the stiffest grip.
        const int steps = std::max(1, static_cast<int>(std::ceil(std::min(dt, 1.0) / 0.25e-3 - 1e-6)));
        Vec3 felt(0.0);
        for (int i = 0; i < steps; ++i) felt = weight_.step(settings, hand_, speed_, press, dt / steps);
        wrench = Wrench{felt, Vec3(0.0)};
        height = weight_.position.z;
        held = weight_.held;
        slides = weight_.slides;
        highest_ = std::max(highest_, weight_.position.z);
        heaviest_ = std::max(heaviest_, -wrench.get().force.z);
    }

    void report(Report& report) const {
        report.set("weight", "highest_mm", highest_ * 1e3);
        report.set("weight", "felt_max_N", heaviest_);
    }

private:
    tactus::simulate::HeldWeight weight_;
    Vec3 hand_{0.0}, speed_{0.0};
    double highest_ = 0.0, heaviest_ = 0.0;
};

TACTUS_NODE(HeldWeight, hand, hand_twist, grip_force, wrench, height, held, slides, mass, friction, stiffness, damping,
            threshold)
TACTUS_VISUALS(HeldWeight)

}  // namespace tactus::nodes
