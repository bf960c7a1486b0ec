// SPDX-License-Identifier: Apache-2.0
// Saws a block at constant thrust by a hand on a simulated device, to verify that the removal does not depend on the
// device.
#pragma once

#include <span>
#include <string_view>

namespace tactus::analysis {

struct DeviceTrial {
    std::string_view model = "ideal";  ///< of simulate::device_models()
    double scale = 1.0;  ///< forces on the device divided by those of the tool
    double stiffness = 40e3;  ///< N/m of the tool; the hand receives `scale` times as much
    double thrust = 10.0;  ///< N at the tool, with which the hand pushes
    double settle = 10.0, seconds = 5.0;  ///< s before and during the measurement
};

struct DeviceTrialResult {
    double thrust = 0.0;  ///< N at the tool: mean force of the device divided by `scale`
    double rubbing = 0.0;  ///< N, mean thrust at which the teeth in contact only rub
    double removal = 0.0;  ///< m³/s
    double limited = 0.0;  ///< fraction of the time in which the device gave less than the commanded force
    double per_thrust = 0.0;  ///< m³/(N·s): removed volume over the time integral of the thrust above rubbing
};

/// Uses a compact block 12 mm wide. Throws Error for an unknown model.
DeviceTrialResult run_device_trial(const DeviceTrial& trial);

/// One trial per class of devices, with the scale required for weak devices: ideal, omega, Falcon, Touch.
std::span<const DeviceTrial> device_trials() noexcept;

}  // namespace tactus::analysis
