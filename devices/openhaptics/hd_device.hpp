// SPDX-License-Identifier: Apache-2.0
// Driver "touch": 3D Systems Touch, Touch X and PHANTOM, by OpenHaptics' device layer.
#pragma once

#include "devices/driver/backend.hpp"
#include "graph/node/options.hpp"

#include <memory>

namespace tactus::openhaptics {

/// Options: library, config (the device name from the vendor's setup program). Throws Error.
std::unique_ptr<driver::Backend> make_touch(Options& options);

}  // namespace tactus::openhaptics
