// SPDX-License-Identifier: Apache-2.0
// The program that runs one driver for an engine.
#pragma once

namespace tactus::hosted {

/// Main function of `tactus-device-host`, and of any program that first adds its own drivers
/// (haptic::add_haptic_driver). Exit code: 0 normal end, 2 the device cannot be opened, 3 the driver did not return.
int run_device_host() noexcept;

}  // namespace tactus::hosted
