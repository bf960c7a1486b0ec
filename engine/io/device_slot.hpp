// SPDX-License-Identifier: Apache-2.0
// An opened device and the state that its group, the watchdog and edits share.
#pragma once

#include "engine/io/device_guard.hpp"
#include "graph/node/device.hpp"
#include "graph/node/setup.hpp"

#include <memory>
#include <string>

namespace tactus::io {

/// A device of one group; see graph/node/setup.hpp for the interface that nodes use.
struct DeviceSlot {
    std::string name;
    std::unique_ptr<HapticDevice> device;
    DevicePort port;
    int group = -1;
    int id = 0;  ///< within its group
    Flicks period = 0;  ///< of that group
    DeviceGuard guard;  ///< in live runs
    Wrench committed;  ///< of the last tick
    Flicks settled = 0;  ///< logical time from which values on the force path are computed; forces are suspended before
    int overdue = -1;  ///< index in the program's sources of the one whose values cannot be used now; −1: none
};

}  // namespace tactus::io
