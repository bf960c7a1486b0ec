// SPDX-License-Identifier: Apache-2.0
// Detection of devices that are lost during a run.
#pragma once

#include "engine/io/device_slot.hpp"

#include <string>

namespace tactus::io {

/// Services a device that has its own process. Returns the reason if the device is lost, otherwise "". Control thread
/// of a live run.
std::string service_device(DeviceSlot& slot);

/// Returns the last result of `service_device`.
std::string loss_of(const DeviceSlot& slot);

}  // namespace tactus::io
