// SPDX-License-Identifier: Apache-2.0
// The program that runs one driver for an engine.
#pragma once

namespace tactus::hosted {

/// What `tactus-device-host` does, and any program that adds drivers of its own first (haptic::add_haptic_driver). The
/// exit code: 0 ended in order, 2 the device cannot be opened, 3 the driver did not return.
int run_device_host() noexcept;

}  // namespace tactus::hosted
