// SPDX-License-Identifier: Apache-2.0
// How stiff a patch may feel on a device, given the delay between a sample and its force.
#pragma once

#include "graph/compile/plan.hpp"
#include "graph/node/device.hpp"

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
    unknown,  ///< the declared stiffness exceeds what a hand alone damps, and the device states no damping
};

/// A loop through a hand: device in, nodes, device out.
struct ForceLoop {
    std::string from, to;      ///< names of nodes
    double graph_s = 0.0;  ///< from a sample to the force it leads to, by the way that leaves the least stiffness
    double latency_s = 0.0;  ///< `loop_delay` of that way
    double period_s = 0.0;  ///< for which a force is held
    double damping = 0.0;  ///< of the device that is pushed with a hand on it, N·s/m
    bool is_damping_stated = false;  ///< false: the device states none, and `damping` is that of a hand alone
    double limit = 0.0;  ///< largest stable stiffness, N/m
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
    int node = -1;  ///< index of the node that has it
    int sink = -1;  ///< index of the node that gives the force to the device
    double scale =
        1.0;  ///< of the parameter's N/m, at the device: of workspaces, squared, and the node's `device_scale`
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

/// s from a motion of the hand to the force that answers it: the latency of the graph, and at each end of the loop half of
/// the delay of its device, which includes its driver and its process (DeviceInfo::delay).
constexpr double loop_delay(double graph_s, double source_delay_s, double sink_delay_s) {
    return graph_s + 0.5 * (source_delay_s + sink_delay_s);
}

/// N·s/m, of a device with a hand on it. One that states none has that of `control::StatedHand` at least.
double damping_with_hand(const DeviceInfo& device);

/// All paths from a device_input to a device_output, one line for each pair, in order of names. `device_of` returns the
/// figures of a device by its name in the patch ("": the only one). A workspace on the path multiplies the stiffness by the
/// square of its scale. A stiffness that a wire drives stays below `max_stiffness` of the device, since the run limits it
/// (engine/build/fit_to_devices.cpp).
std::vector<ForceLoop> force_loops(const compile::Plan& plan,
                                   const std::function<DeviceInfo(const std::string&)>& device_of);

/// A class of devices, to compare a patch on other devices. Makers state no damping: it is assumed, of the mechanism
/// alone, as in dsp/simulate/device_model.cpp; so is the delay, s. Stiffness as makers state it for the weakest axis, N/m.
struct DeviceClass {
    const char* name;
    double damping, delay, max_stiffness;
};
std::span<const DeviceClass> device_classes();

}  // namespace tactus::analyse
