// SPDX-License-Identifier: Apache-2.0
#include "dsp/guide/guide_law.hpp"
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Viscosity {
    static constexpr auto about =
        "Drag against the motion of the hand: force = -damping × velocity. It only takes energy, and is bounded by "
        "'max_force' and 'max_torque'.";

    In<Twist> twist{"of the hand", "m/s, rad/s"};
    Out<Wrench> wrench{"on the hand, about its origin", "N, N m"};
    Param damping{"5 N s/m", "0 N s/m", "50 N s/m", "force per velocity"};
    Param angular_damping{"0 N m s/rad", "0 N m s/rad", "1 N m s/rad", "torque per angular velocity"};
    Param max_force{"3 N", "0 N", "50 N", "largest force of the drag"};
    Param max_torque{"0.1 N m", "0 N m", "5 N m", "largest torque of the drag"};

    void process(const Tick&) noexcept {
        wrench = {against(twist->linear, damping, max_force), against(twist->angular, angular_damping, max_torque)};
    }

private:
    static Vec3 against(const Vec3& v, double damping, double most) noexcept {
        if (!(std::abs(v.x) < 1e6 && std::abs(v.y) < 1e6 && std::abs(v.z) < 1e6)) return Vec3(0.0);
        return guide::limited_sum(Vec3(0.0), v * -damping, most);
    }
};

TACTUS_NODE(Viscosity, twist, wrench, damping, angular_damping, max_force, max_torque)

}  // namespace tactus::nodes
