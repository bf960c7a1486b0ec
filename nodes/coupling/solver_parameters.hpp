// SPDX-License-Identifier: Apache-2.0
// Parameters common to the quasi-static couplings.
#pragma once

#include "dsp/core/rotation.hpp"
#include "dsp/core/types.hpp"
#include "dsp/coupling/held_contact.hpp"
#include "dsp/coupling/quasi_static.hpp"
#include "graph/node/node.hpp"

#include <algorithm>
#include <limits>

namespace tactus::nodes {

struct SolverParameters {
    Param stiffness{"1 N/mm", "0 N/mm", "20 N/mm", "of the spring to the hand"};
    Param angular_stiffness{"1 N m/rad", "0 N m/rad", "100 N m/rad", "of the rotational spring"};
    Param max_force{"10 N", "0 N", "100 N", "limit of the spring force"};
    Param max_torque{"0.5 N m", "0 N m", "20 N m", "limit of the spring torque"};
    Param iterations{discrete, "10", "1", "50", "maximum number of solver steps in a tick"};
    Param tolerance{"0.001 N", "0 N", "1 N", "residual below which the body counts as balanced"};
    Param step{
        "0.5 mm", "0.05 mm", "20 mm",
        "limit of a point's motion per solver step beyond the free distance; never more than half a voxel of the "
        "finest field that is touched"};
    TACTUS_GROUP(stiffness, angular_stiffness, max_force, max_torque, iterations, tolerance, step)

    /// For the body of `contact`; `share` scales the springs.
    void set(coupling::QuasiStaticSettings& settings, const coupling::HeldContact& contact,
             double share) const noexcept {
        settings.springs = {{stiffness * share, max_force * share}, {angular_stiffness * share, max_torque * share}};
        settings.iterations = static_cast<int>(iterations);
        settings.tolerance = tolerance;
        settings.step = std::min(step.value, contact.safe_step());
        settings.reach = contact.reach();
        settings.gyration = contact.gyration();
    }

    /// Bounds the motion of the body in the next `elapsed` s beyond that of the hand, m and rad. Where a body tips over an edge,
    /// its balance ends and the next one lies elsewhere: the body takes so many ticks for the way that the springs change by
    /// no more than 100 N/s and 5 N·m/s. A saturated spring changes by its force over its stretch.
    static void slow_down(coupling::QuasiStaticSettings& settings, const Pose& proxy, const Pose& hand,
                          double elapsed) noexcept {
        constexpr double force_rate = 100.0, torque_rate = 5.0;
        // Without a valid hand the body waits where it is: the springs keep pulling towards the last one.
        settings.shift = settings.turn = 0.0;
        if (!is_valid(hand)) return;
        settings.shift = settings.turn = std::numeric_limits<double>::infinity();
        elapsed = std::min(elapsed, 0.02);  // a pause of the thread is no time in which a hand could follow
        const double linear = settings.springs.linear(proxy.position - hand.position).curvature;
        const double angular =
            settings.springs.angular(rotation_between(hand.orientation, proxy.orientation)).curvature;
        if (linear > 0.0) settings.shift = force_rate * elapsed / linear;
        if (angular > 0.0) settings.turn = torque_rate * elapsed / angular;
    }
};

}  // namespace tactus::nodes
