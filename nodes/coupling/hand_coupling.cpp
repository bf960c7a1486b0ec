// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/rotation.hpp"
#include "dsp/coupling/coupling_spring.hpp"
#include "dsp/coupling/shared_energy.hpp"
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::nodes {

struct HandCoupling {
    static constexpr auto about =
        "A spring and a damper between two hands, which declares that one may lead the other: what one hand puts in is "
        "granted to the other, so that its energy cap lets the force through. Wire 'granted_a' and 'granted_b' to "
        "'granted' of the two device_outputs. Both poses must be in the same frame.";

    In<Pose> a{"pose of one hand", "m"};
    In<Pose> b{"pose of the other hand", "m"};
    In<Twist> a_twist{optional, "velocity of the one, for the damper", "m/s, rad/s"};
    In<Twist> b_twist{optional, "velocity of the other, for the damper", "m/s, rad/s"};
    Out<Wrench> on_a{"on the one, about its origin", "N, N m"};
    Out<Wrench> on_b{"on the other, about its origin: the opposite", "N, N m"};
    Out<double> granted_a{"power that the one may be given", "W"};
    Out<double> granted_b{"power that the other may be given", "W"};
    Param stiffness{"1 N/mm", "0 N/mm", "20 N/mm", "force per distance between the hands"};
    Param damping{"0 N s/m", "0 N s/m", "50 N s/m", "force per relative velocity"};
    Param angular_stiffness{"0 N m/rad", "0 N m/rad", "20 N m/rad",
                            "torque per angle between the hands; it falls from 135° to nothing at 180°"};
    Param angular_damping{"0 N m s/rad", "0 N m s/rad", "1 N m s/rad", "torque per relative angular velocity"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::spring, .pose = "b", .hand = "a", .force = "on_a"}};
    }

    void process(const Tick& tick) noexcept {
        using tactus::coupling::TurnSpring;
        const Vec3 away = b->position - a->position, turn = rotation_between(a->orientation, b->orientation);
        const Vec3 angle = TurnSpring::effective(turn);
        const Wrench wrench{
            away * stiffness.value + (b_twist->linear - a_twist->linear) * damping.value,
            angle * angular_stiffness.value + (b_twist->angular - a_twist->angular) * angular_damping.value};
        on_a = wrench;
        on_b = wrench * -1.0;
        const double stored =
            0.5 * stiffness.value * glm::dot(away, away) + 0.5 * angular_stiffness.value * TurnSpring::square(turn);
        const auto grants = energy_.tick({{{a.get(), on_a.get()}, {b.get(), on_b.get()}}}, stored,
                                         std::max(tick.elapsed_seconds(), seconds(tick.period)));
        granted_a = grants[0];
        granted_b = grants[1];
    }

private:
    tactus::coupling::SharedEnergy energy_;
};

TACTUS_NODE(HandCoupling, a, b, a_twist, b_twist, on_a, on_b, granted_a, granted_b, stiffness, damping,
            angular_stiffness, angular_damping)
TACTUS_VISUALS(HandCoupling)

}  // namespace tactus::nodes
