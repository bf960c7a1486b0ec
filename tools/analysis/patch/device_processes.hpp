// SPDX-License-Identifier: Apache-2.0
// Which devices of a patch have a process of their own.
#pragma once

#include "graph/compile/schedule.hpp"

#include <string>
#include <vector>

namespace tactus::analysis {

/// A device with a process of its own.
struct DeviceProcess {
    std::string device;
    double rate_hz = 0.0;    ///< of the process
    double added_s = 0.0;    ///< largest, from a sample to its force
};

/// Those that nodes of the plan use. Throws Error on options that cannot be read.
std::vector<DeviceProcess> device_processes(const compile::Schedule& plan);

}  // namespace tactus::analysis
