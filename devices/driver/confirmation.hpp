// SPDX-License-Identifier: Apache-2.0
// Records of the devices whose push directions a person has confirmed, by serial number.
#pragma once

#include "devices/driver/backend.hpp"

#include <filesystem>
#include <string_view>

namespace tactus::driver {

/// $XDG_CONFIG_HOME/tactus/devices.json, else ~/.config/tactus/devices.json; empty when neither variable is set.
std::filesystem::path confirmations_file();

/// Also returns false if the file cannot be read, and for a device without a serial number.
bool is_confirmed(std::string_view driver, const Opened& device);

/// Records that a person has confirmed the directions. Throws Error if the device has no serial number, or if the file
/// cannot be read or written.
void confirm(std::string_view driver, const Opened& device);

/// Removes the confirmation. Throws Error as `confirm` does.
void forget(std::string_view driver, const Opened& device);

}  // namespace tactus::driver
