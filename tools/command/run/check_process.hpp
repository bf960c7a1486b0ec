// SPDX-License-Identifier: Apache-2.0
// What a process of its own costs a device: later forces, hence less stiffness.
#pragma once

#include "graph/analyse/stiffness.hpp"
#include "graph/compile/plan.hpp"

#include <string>
#include <vector>

namespace tactus::command {

/// A device with a process of its own.
struct DeviceProcess {
    std::string device;
    double rate_hz = 0.0;    ///< of the process
    double added_s = 0.0;    ///< largest, from a sample to its force
};

/// Those that nodes of the plan use. Throws Error on options that cannot be read.
std::vector<DeviceProcess> device_processes(const compile::Plan& plan);

/// Adds the delay to the loops through such devices, live runs have it: half of it where a loop begins, half where it
/// ends.
void add_process_delay(std::vector<analyse::ForceLoop>& loops, const compile::Plan& plan);

}  // namespace tactus::command
