// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::nodes {

struct DirectCoupling {
    static constexpr auto about =
        "Direct coupling: the body is rigidly attached to the hand. The contact force is scaled so that the stiffness "
        "of all points together stays below a limit. Until the body comes free again the scale only falls, so that no "
        "path "
        "gives energy to the hand. A thin wall can be passed through; a proxy prevents that (thesis 2.4.2).";

    In<Wrench> contact{"on the body, about the origin of the hand: voxmap_contact.wrench", "N, N m"};
    In<double> contact_stiffness{"of all touching points together: voxmap_contact.stiffness", "N/m"};
    Out<Wrench> wrench{"on the hand", "N, N m"};
    Param stiffness{"0.8 N/mm", "0 N/mm", "20 N/mm",
                    "upper bound of the stiffness that the hand feels, for any number of points in contact"};
    Param max_force{"10 N", "0 N", "100 N", "limit of the force; the torque is reduced in the same ratio"};

    void process(const Tick&) noexcept {
        const double all = contact_stiffness.get();
        const bool touches = contact->force != Vec3(0.0) || contact->torque != Vec3(0.0);
        // The work of a contact energy E that is scaled by s over a path from free to free is ∫E ds: never positive while s
        // falls. A scale that followed the contact up again would give energy.
        if (!touches && !(all > 0.0)) scale_ = 1.0;
        else if (all > stiffness) scale_ = std::min(scale_, stiffness / all);
        const Wrench scaled = contact.get() * scale_;
        const double size = glm::length(scaled.force);
        wrench = scaled * (size > max_force ? max_force / size : 1.0);
    }

private:
    double scale_ = 1.0;  // of this touch
};

TACTUS_NODE(DirectCoupling, contact, contact_stiffness, wrench, stiffness, max_force)

}  // namespace tactus::nodes
