// SPDX-License-Identifier: Apache-2.0
// Whether a device runs in a separate process, as set in [devices.NAME] of a patch.
#pragma once

#include "graph/node/options.hpp"

#include <string_view>

namespace tactus::hosted {

struct Placement {
    bool own_process = false;
    double rate = 0.0;  ///< Hz at which the process serves the device; 0: four times the rate of its nodes
    double open_timeout = 10.0;  ///< time in s that a driver has to open its device

    /// Time in s between two rounds of the process, for nodes of `period_s`.
    double round_s(double period_s) const;
    /// Maximum delay in s that the process adds compared with the driver inside the engine: a sample waits for one
    /// round, and so does a force.
    double added_latency_s(double period_s) const { return own_process ? 2.0 * round_s(period_s) : 0.0; }
};

/// Reads the options common to all devices: process (true for hardware, false for simulated devices), process_rate,
/// open_timeout. Throws Error.
Placement read_placement(Options& options, std::string_view driver);

}  // namespace tactus::hosted
