// SPDX-License-Identifier: Apache-2.0
// How stiff a patch may feel: what the delay between feeling and force leaves of it.
#pragma once

#include "graph/compile/plan.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tactus::analyse {

/// A node that makes a force from a position: one with a parameter in N/m.
struct DeclaredStiffness {
    std::string param;              ///< "blade.stiffness"
    double newton_per_metre =
        0.0;  ///< its value, or the end of its range when a wire drives it; in the device's metres
};

/// A loop through a hand: device in, nodes, device out.
struct ForceLoop {
    std::string from, to;      ///< names of nodes
    double latency_s = 0.0;  ///< from a sample to the force it leads to, by the way that leaves the least stiffness
    double damping = 0.0;  ///< of the device that is pushed, N·s/m
    double limit = 0.0;  ///< largest stable stiffness, N/m; 0 when the device states no damping
    std::optional<DeclaredStiffness> declared;  ///< the stiffest on that way, if there is any
    bool ok() const { return !declared || limit == 0.0 || declared->newton_per_metre < limit; }
};

/// Largest stiffness of a spring that a hand's device, of damping b in N·s/m, can feel without humming when its force is
/// held for `period_s` and comes `delay_s` late: b / (T/2 + t_d), that is b / (T (½ + D)) for D periods of delay.
/// Colgate and Schenkel 1997 for no delay; Gil, Sánchez, Hulin, Preusche and Hirzinger 2009 with delay. For an ideal mass
/// and damper; measured limits are up to 20 % lower.
constexpr double stiffness_limit(double damping, double period_s, double delay_s) {
    return damping / (0.5 * period_s + delay_s);
}

/// Every way from a device_input to a device_output, one line for each pair, in order of names. `damping` is asked for
/// that of a device by its name in the patch ("": the only one). A workspace on the way enlarges what is felt by the
/// square of its scale.
std::vector<ForceLoop> force_loops(const compile::Plan& plan, const std::function<double(const std::string&)>& damping);

}  // namespace tactus::analyse
