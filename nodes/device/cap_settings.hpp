// SPDX-License-Identifier: Apache-2.0
// The energy cap of a device, as `device_output` prepares it and `check` reports its bound.
#pragma once

#include "dsp/control/energy_cap.hpp"
#include "graph/node/device.hpp"

#include <algorithm>

namespace tactus::nodes {

/// `info` after the device was prepared: its delay includes the driver and its process.
inline control::EnergyCapSettings cap_settings(const DeviceInfo& info, double period_s) {
    control::EnergyCapSettings cap;
    cap.period_s = period_s;
    if (info.resolution > 0.0) cap.resolution = info.resolution;
    if (info.angular_resolution > 0.0) cap.angular_resolution = info.angular_resolution;
    cap.delay_s = info.delay;
    // A device states its damping with a hand on it. A larger value would blur the rebound from a surface.
    cap.damping = std::clamp(info.damping, cap.damping, 5.0);
    return cap;
}

}  // namespace tactus::nodes
