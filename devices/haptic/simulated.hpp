// SPDX-License-Identifier: Apache-2.0
// Driver "simulated": a simulated hand that presses a blade with a set thrust and saws.
#pragma once

#include "graph/node/device.hpp"
#include "graph/node/options.hpp"

#include <memory>

namespace tactus::haptic {

/// Options are those of StrokePlan and HandDynamics; `tactus devices` and a wrong name list them. Throws Error.
std::unique_ptr<HapticDevice> open_simulated(Options& options);

}  // namespace tactus::haptic
