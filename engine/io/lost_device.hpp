// SPDX-License-Identifier: Apache-2.0
// Devices that are lost while a run lasts.
#pragma once

#include "engine/build/group_program.hpp"

#include <string>

namespace tactus::io {

/// Looks after the process of a device that has one. Why the device is lost, or "". Control thread of a live run.
std::string service_device(build::DeviceSlot& slot);

/// What `service_device` said last.
std::string loss_of(const build::DeviceSlot& slot);

}  // namespace tactus::io
