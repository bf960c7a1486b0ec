// SPDX-License-Identifier: Apache-2.0
// What `tactus devices` does with one real device: read it, or ask which way it pushes.
#pragma once

#include <string>
#include <vector>

namespace tactus::command {

struct DeviceLook {
    std::string driver;
    std::vector<std::string> options;  ///< NAME=VALUE, as in [devices.NAME] of a patch
    bool json = false;
};

/// Opens the device, enables nothing, gives no force; prints versions, pose and rate, or the step that failed. The exit
/// code: 0 it can be read, 1 it cannot.
int probe_device(const DeviceLook& look);

/// Pushes gently along each axis and asks which way; keeps the answer for the device's serial number. The exit code: 0
/// all directions were right, 1 one was not. Throws Error.
int verify_device(const DeviceLook& look);

}  // namespace tactus::command
