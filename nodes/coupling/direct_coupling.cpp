// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <glm/geometric.hpp>

namespace tactus::nodes {

struct DirectCoupling {
    static constexpr auto about =
        "The hand itself is the body: it feels the contact forces, scaled down so that all points together are no "
        "stiffer "
        "than it can feel. Goes through what is thinner than the force is deep; a proxy does not (thesis 2.4.2).";

    In<Wrench> contact{"on the body, about the hand's origin: voxmap_contact.wrench", "N, N m"};
    In<double> contact_stiffness{"of all touching points together: voxmap_contact.stiffness", "N/m"};
    Out<Wrench> wrench{"on the hand", "N, N m"};
    Param stiffness{"0.8 N/mm", "0 N/mm", "20 N/mm", "the largest the hand can feel, however many points touch"};
    Param max_force{"10 N", "0 N", "100 N", "the force grows no larger; the torque shrinks with it"};

    void process(const Tick&) noexcept {
        const double all = contact_stiffness.get();
        const Wrench scaled = contact.get() * (all > stiffness ? stiffness / all : 1.0);
        const double size = glm::length(scaled.force);
        wrench = scaled * (size > max_force ? max_force / size : 1.0);
    }
};

TACTUS_NODE(DirectCoupling, contact, contact_stiffness, wrench, stiffness, max_force)

}  // namespace tactus::nodes
