// SPDX-License-Identifier: Apache-2.0
// The parameters that the nodes share which hold a body by springs and solve for its balance.
#pragma once

#include "dsp/coupling/held_contact.hpp"
#include "dsp/coupling/quasi_static.hpp"
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct SolverParameters {
    Param stiffness{"1 N/mm", "0 N/mm", "20 N/mm", "of the spring to the hand"};
    Param angular_stiffness{"1 N m/rad", "0 N m/rad", "100 N m/rad", "of the spring that turns"};
    Param max_force{"10 N", "0 N", "100 N", "the spring pulls no harder"};
    Param max_torque{"0.5 N m", "0 N m", "20 N m", "the spring turns no harder"};
    Param iterations{"10", "1", "50", "most steps of the solver in one tick"};
    Param tolerance{"0.001 N", "0 N", "1 N", "residual that counts as balanced"};
    Param step{"0.5 mm", "0.001 mm", "20 mm",
               "farthest that one step may move a point beyond what is free; at most half of the thinnest walls"};
    TACTUS_GROUP(stiffness, angular_stiffness, max_force, max_torque, iterations, tolerance, step)

    /// For the body that `contact` is set to; the springs with a share of their strength.
    void set(coupling::QuasiStaticSettings& settings, const coupling::HeldContact& contact, double share) const noexcept {
        settings.springs = {{stiffness * share, max_force * share}, {angular_stiffness * share, max_torque * share}};
        settings.iterations = static_cast<int>(iterations);
        settings.tolerance = tolerance;
        settings.step = step;
        settings.reach = contact.reach();
        settings.gyration = contact.gyration();
    }
};

}  // namespace tactus::nodes
