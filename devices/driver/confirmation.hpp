// SPDX-License-Identifier: Apache-2.0
// Which devices pushed in the directions that they should: a person said so, once for each serial number.
#pragma once

#include "devices/driver/backend.hpp"

#include <filesystem>
#include <string_view>

namespace tactus::driver {

/// $XDG_CONFIG_HOME/tactus/devices.json, else ~/.config/tactus/devices.json; empty when neither variable is set.
std::filesystem::path confirmations_file();

/// False also when the file cannot be read, and for a device without a serial number.
bool is_confirmed(std::string_view driver, const Opened& device);

/// Notes that a person confirmed the directions. Throws Error when the device has no serial number, or the file cannot
/// be read or written.
void confirm(std::string_view driver, const Opened& device);

/// Takes it back. Throws Error as `confirm` does.
void forget(std::string_view driver, const Opened& device);

}  // namespace tactus::driver
