// SPDX-License-Identifier: Apache-2.0
// The haptic drivers there are.
#pragma once

#include "devices/haptic/replay.hpp"
#include "graph/node/device.hpp"
#include "graph/node/options.hpp"

#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace tactus::haptic {

struct HapticDriver {
    std::string name;
    std::string summary;  ///< one line for people
    std::unique_ptr<HapticDevice> (*open)(Options& options, const PathResolver& resolve);
    bool is_real = false;  ///< hardware: runs in real time only
};

/// All drivers, in the order in which they are listed to users.
std::span<const HapticDriver> haptic_drivers();

/// Adds a driver that the program brings along: a device in the laboratory, or one that a test plays. Before anything
/// is opened; a driver of the same name is replaced.
void add_haptic_driver(HapticDriver driver);

/// True for a driver of hardware.
bool is_real_driver(std::string_view driver);

/// Opens a device of the driver `driver` with the options a patch gives it. `where` is where the patch names the
/// driver. Throws Error on an unknown driver, listing all, and on options the driver refuses.
std::unique_ptr<HapticDevice> open_haptic_device(std::string_view driver, const SourceLocation& where, Options& options,
                                                 const PathResolver& resolve);

}  // namespace tactus::haptic
