// SPDX-License-Identifier: Apache-2.0
// Haptic devices as they are: figures of desktop devices, and their mechanics, sensors and drives.
#pragma once

#include "dsp/control/adaptive_window.hpp"
#include "dsp/simulate/hand.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

namespace tactus::simulate {

/// Figures of a device at its handle. docs/reference/devices.md names the source of each.
struct DeviceModel {
    std::string_view name, about;
    double mass = 0.0;                ///< kg, apparent at the handle
    double inertia = 0.0;             ///< kg·m², of the handle
    double viscous = 0.0;             ///< N·s/m
    double friction = 0.0;            ///< N, Coulomb
    double angular_viscous = 0.0;     ///< N·m·s/rad
    double angular_friction = 0.0;    ///< N·m
    double resolution = 0.0;          ///< m, step of the position
    double angular_resolution = 0.0;  ///< rad
    double force_step = 0.0;          ///< N, quantum of the drive
    double max_force = 0.0;           ///< N
    double torque_step = 0.0;         ///< N·m
    double max_torque = 0.0;          ///< N·m; 0: the device gives none
    double delay = 0.0;               ///< s, from a motion through sample and command to the force
    double max_stiffness = 0.0;       ///< N/m, as the maker states it
};

/// "touch", "omega" and "falcon".
std::span<const DeviceModel> device_models();
/// The ideal device for any other name.
const DeviceModel* find_device_model(std::string_view name);

/// A hand on a device of that model. Force: saturated, quantised, late. Sample: quantised pose, velocity by an adaptive
/// window.
class ModelledDevice {
public:
    /// `hand.mass` and `hand.inertia` are the hand's own; the device's are added.
    ModelledDevice(const DeviceModel& model, HandDynamics hand);

    void place(const Pose& start) noexcept;
    void launch(const Twist& twist) noexcept { hand_.twist = twist; }

    /// Advances by `elapsed_s`; `command` was given at the beginning of that time. `intend` as in `simulate::advance`.
    template <typename Intend>
    void advance(Intend& intend, const Wrench& command, double elapsed_s) noexcept {
        if (!(elapsed_s > 0.0)) return;
        give(command);
        const int steps = std::max(1, static_cast<int>(std::ceil(std::min(elapsed_s, 10.0) / hand_substep_s - 1e-6)));
        const double h = elapsed_s / steps;
        for (int i = 0; i < steps; ++i) {
            const Wrench felt = acting();
            hand_.step(h, intend(h, felt, hand_.pose), felt);
            time_ += h;
        }
        sense(elapsed_s);
    }

    const Pose& pose() const noexcept { return seen_; }  ///< as the encoders report it
    const Twist& twist() const noexcept { return twist_; }  ///< as estimated from that
    const Hand& truth() const noexcept { return hand_; }
    /// The wrench on the hand now.
    Wrench acting() const noexcept;

private:
    struct Command {
        double time = 0.0;  // s
        Wrench wrench;
    };

    void give(const Wrench& command) noexcept;
    void sense(double elapsed_s) noexcept;

    DeviceModel model_;
    Hand hand_;
    std::array<Command, 256> commands_{};  // a ring; the newest is at newest_
    std::size_t newest_ = 0;
    double time_ = 0.0;
    Pose seen_;
    Twist twist_;
    Vec3 angle_{0.0};
    control::AdaptiveWindow speed_, spin_;
};

}  // namespace tactus::simulate
