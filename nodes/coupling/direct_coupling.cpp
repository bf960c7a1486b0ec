// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <glm/geometric.hpp>

namespace tactus::nodes {

struct DirectCoupling {
    static constexpr auto about =
        "Direct coupling: the body is rigidly attached to the hand. The contact force is scaled so that the stiffness "
        "of all points together stays below a limit. A thin wall can be passed through; a proxy prevents that (thesis "
        "2.4.2).";

    In<Wrench> contact{"on the body, about the origin of the hand: voxmap_contact.wrench", "N, N m"};
    In<double> contact_stiffness{"of all touching points together: voxmap_contact.stiffness", "N/m"};
    Out<Wrench> wrench{"on the hand", "N, N m"};
    Param stiffness{"0.8 N/mm", "0 N/mm", "20 N/mm",
                    "upper bound of the stiffness that the hand feels, for any number of points in contact"};
    Param max_force{"10 N", "0 N", "100 N", "limit of the force; the torque is reduced in the same ratio"};

    void process(const Tick&) noexcept {
        const double all = contact_stiffness.get();
        const Wrench scaled = contact.get() * (all > stiffness ? stiffness / all : 1.0);
        const double size = glm::length(scaled.force);
        wrench = scaled * (size > max_force ? max_force / size : 1.0);
    }
};

TACTUS_NODE(DirectCoupling, contact, contact_stiffness, wrench, stiffness, max_force)

}  // namespace tactus::nodes
