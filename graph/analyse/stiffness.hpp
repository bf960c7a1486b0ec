// SPDX-License-Identifier: Apache-2.0
// How stiff a patch may feel on a device, given the delay between a sample and its force.
#pragma once

#include "graph/compile/plan.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::analyse {

/// A node that makes a force from a position: one with a parameter in N/m, or one of known slope.
struct DeclaredStiffness {
    std::string param;              ///< "blade.stiffness", "law (its slope)"
    double newton_per_metre =
        0.0;  ///< its value, or the end of its range when a wire drives it; in the device's metres
    bool is_driven = false;  ///< by a wire
};

enum class Verdict : std::uint8_t {
    stable,
    too_stiff,  ///< beyond what the damping of the device permits, or beyond what its maker states
    unknown,  ///< a stiffness is declared, but the device states no damping
};

/// A loop through a hand: device in, nodes, device out.
struct ForceLoop {
    std::string from, to;      ///< names of nodes
    double latency_s = 0.0;  ///< from a sample to the force it leads to, by the way that leaves the least stiffness
    double period_s = 0.0;  ///< for which a force is held
    double damping = 0.0;  ///< of the device that is pushed, N·s/m
    double limit = 0.0;  ///< largest stable stiffness, N/m; 0 when the device states no damping
    double max_stiffness = 0.0;  ///< of the device, N/m, as its maker states it; 0: not stated
    std::optional<DeclaredStiffness> declared;  ///< the stiffest on that way, if there is any

    Verdict verdict() const;
    bool ok() const { return verdict() == Verdict::stable; }
};

/// A parameter in N/m between a hand's device and its force, and its scale at the device.
struct FeltSpring {
    std::string name;  ///< "blade.stiffness"
    SourceLocation where;  ///< of its value, or of its node
    Param* param = nullptr;
    int sink = -1;  ///< index of the node that gives the force to the device
    double scale = 1.0;  ///< of the parameter's N/m, at the device
    bool is_driven = false;  ///< by a wire
};

/// All such parameters on all paths from a device_input to a device_output, in the order of nodes and names.
std::vector<FeltSpring> felt_springs(const compile::Plan& plan);

/// Per node of the plan: whether it lies on a way from a hand's device to a hand's force.
std::vector<bool> between_hand_and_force(const compile::Plan& plan);

/// Names of the nodes between a hand's device and its force whose law no parameter states and of which no bound on the
/// slope is known, in the order of the patch.
std::vector<std::string> unstated_laws(const compile::Plan& plan);

/// Largest stiffness of a spring that a hand's device, of damping b in N·s/m, can feel without humming when its force is
/// held for `period_s` and comes `delay_s` late: b / (T/2 + t_d), that is b / (T (½ + D)) for D periods of delay.
/// Colgate and Schenkel 1997 for no delay; Gil, Sánchez, Hulin, Preusche and Hirzinger 2009 with delay. For an ideal mass
/// and damper; measured limits are up to 20 % lower.
constexpr double stiffness_limit(double damping, double period_s, double delay_s) {
    return damping / (0.5 * period_s + delay_s);
}

/// All paths from a device_input to a device_output, one line for each pair, in order of names. `damping` returns the
/// damping of a device by its name in the patch ("": the only one). A workspace on the path multiplies the stiffness by the
/// square of its scale. `max_stiffness` is called in the same way; a stiffness that a wire drives stays below it,
/// since the run limits it (engine/build/stiffness_limits.cpp).
std::vector<ForceLoop> force_loops(const compile::Plan& plan, const std::function<double(const std::string&)>& damping,
                                   const std::function<double(const std::string&)>& max_stiffness = {});

/// A class of devices, to compare a patch on other devices. Makers state no damping: these are assumptions for the
/// mechanism with a light grip. Stiffness as makers state it for the weakest axis, N/m.
struct DeviceClass {
    const char* name;
    double damping, max_stiffness;
};
std::span<const DeviceClass> device_classes();

}  // namespace tactus::analyse
