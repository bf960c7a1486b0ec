// SPDX-License-Identifier: Apache-2.0
// Stable stiffness of a patch on a device, from the delay between a sample and its force.
#pragma once

#include "graph/compile/schedule.hpp"
#include "graph/node/device.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::analyse {

/// A node that computes a force from a position: it has a parameter in N/m or a law of known slope.
struct DeclaredStiffness {
    std::string param;              ///< "blade.stiffness", "law (its slope)"
    double newton_per_metre =
        0.0;  ///< its value, or the end of its range when a wire drives it; in metres of the device
    bool is_driven = false;  ///< by a wire
};

enum class Verdict : std::uint8_t {
    stable,
    too_stiff,  ///< beyond the limit of the device's damping, or beyond the maker's maximum stiffness
    unknown,  ///< the stiffness exceeds the limit for the damping of a hand alone, and the device states no damping
};

/// A control loop through a hand: device input, nodes, device output.
struct ForceLoop {
    std::string from, to;  ///< names of nodes
    double graph_s = 0.0;  ///< from a sample to the resulting force, on the path with the smallest stiffness margin
    double latency_s = 0.0;  ///< `loop_delay` of that path
    double period_s = 0.0;  ///< time for which a force is held
    double damping = 0.0;  ///< of the device that receives the force, with a hand on it, N·s/m
    bool is_damping_stated = false;  ///< false: `damping` is that of a hand alone
    double limit = 0.0;  ///< largest stable stiffness, N/m
    double max_stiffness = 0.0;  ///< of the device, N/m, as stated by its maker; 0: not stated
    std::optional<DeclaredStiffness> declared;  ///< the stiffest node on that path, if any

    Verdict verdict() const;
    bool ok() const { return verdict() == Verdict::stable; }
};

/// A parameter in N/m between a hand's device and its force, and its scale at the device.
struct FeltSpring {
    std::string name;  ///< "blade.stiffness"
    SourceLocation where;  ///< of the parameter's value, or of its node
    Param* param = nullptr;
    int node = -1;  ///< index of the node that has it
    int sink = -1;  ///< index of the node that sends the force to the device
    double scale =
        1.0;  ///< factor from the parameter to N/m at the device: squared workspace scales times `device_scale`
    bool is_driven = false;  ///< by a wire
};

/// Returns these parameters on all paths from a device_input to a device_output, ordered by node and name.
std::vector<FeltSpring> felt_springs(const compile::Schedule& plan);

/// Per node of the plan: true if it lies on a path from the device of a hand to a force on a hand.
std::vector<bool> between_hand_and_force(const compile::Schedule& plan);

/// Names of the nodes between a hand's device and its force that state no stiffness parameter and have no known bound
/// on their slope, in the order of the patch.
std::vector<std::string> unstated_laws(const compile::Schedule& plan);

/// Largest stable stiffness of a spring on a device of damping b in N·s/m, when the force is held for T = `period_s`
/// and comes t_d = `delay_s` late: b / (T/2 + t_d), that is b / (T (½ + D)) for D periods of delay. Beyond it the
/// device oscillates. Colgate and Schenkel 1997 for no delay; Gil, Sánchez, Hulin, Preusche and Hirzinger 2009 with
/// delay. Both assume an ideal mass and damper; measured limits are up to 20 % lower.
constexpr double stiffness_limit(double damping, double period_s, double delay_s) {
    return damping / (0.5 * period_s + delay_s);
}

/// Time in s from a motion of the hand to the resulting force: the latency of the graph plus half of the delay of the
/// device at each end of the loop. A device's delay includes its driver and its process (DeviceInfo::delay).
constexpr double loop_delay(double graph_s, double source_delay_s, double sink_delay_s) {
    return graph_s + 0.5 * (source_delay_s + sink_delay_s);
}

/// Damping in N·s/m of a device with a hand on it; for a device that states none, at least that of
/// `control::StatedHand`.
double damping_with_hand(const DeviceInfo& device);

/// Returns the loop of each pair of device_input and device_output, in order of names. `device_of` returns the
/// properties of a device by its name in the patch ("": the only one). A workspace on the path multiplies the stiffness
/// by the square of its scale. A stiffness that a wire drives counts at most as the device's `max_stiffness`, because
/// the engine clamps it during a run (engine/build/fit_to_devices.cpp).
std::vector<ForceLoop> force_loops(const compile::Schedule& plan,
                                   const std::function<DeviceInfo(const std::string&)>& device_of);

/// A class of devices, to compare a patch on other devices. Makers state neither damping nor delay (s): both are
/// assumed as in dsp/simulate/device_model.cpp, the damping for the mechanism without a hand. The stiffness is the
/// maker's figure for the weakest axis, N/m.
struct DeviceClass {
    const char* name;
    double damping, delay, max_stiffness;
};
std::span<const DeviceClass> device_classes();

}  // namespace tactus::analyse
