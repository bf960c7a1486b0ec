// SPDX-License-Identifier: Apache-2.0
// Driver "simulated": an operator who presses a blade into whatever is in the way and saws.
#pragma once

#include "graph/device.hpp"
#include "graph/options.hpp"

#include <memory>

namespace tactus {

/// Options are those of StrokePlan and HandDynamics; `tactus devices` and a wrong name list them. Throws Error.
std::unique_ptr<HapticDevice> open_simulated(Options& options);

}  // namespace tactus
