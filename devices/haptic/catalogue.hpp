// SPDX-License-Identifier: Apache-2.0
// The catalogue of haptic drivers.
#pragma once

#include "devices/driver/backend.hpp"
#include "devices/driver/threaded_device.hpp"
#include "devices/haptic/replay.hpp"
#include "graph/node/device.hpp"
#include "graph/node/options.hpp"

#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace tactus::haptic {

/// Properties of hardware that are available without opening it.
struct HardwareOutline {
    DeviceInfo info;
    std::string absence;  ///< why it cannot be present, "there is no /dev/ttyUSB0"; empty: it may be
};

struct HapticDriver {
    std::string name;
    std::string summary;  ///< one line, shown to users
    std::unique_ptr<HapticDevice> (*open)(Options& options, const PathResolver& resolve) = nullptr;
    bool is_real = false;  ///< hardware; runs in real time only
    /// For hardware: reads the options as `open` does and opens nothing. Null if the driver does not support it.
    HardwareOutline (*describe)(Options& options, const PathResolver& resolve) = nullptr;
    bool needs_window = false;  ///< a person moves it at the window of a live run
    /// For a device behind a Backend, instead of `open` and `describe`: reads all options.
    std::unique_ptr<driver::Backend> (*backend)(Options& options) = nullptr;
    bool is_untested = false;  ///< not yet tested with its device
};

/// All drivers, in the order of listings.
std::span<const HapticDriver> haptic_drivers();

/// Registers a driver of an embedding program or a test. Call it before any device is opened. It replaces a driver of
/// the same name.
void add_haptic_driver(HapticDriver driver);

/// True for a driver of hardware.
bool is_real_driver(std::string_view driver);

/// True for a driver that a person moves at a window.
bool needs_window(std::string_view driver);

/// Opens a device behind a Backend for inspection, whether or not its push directions are confirmed. Throws Error, also
/// for a driver without a Backend.
std::unique_ptr<driver::ThreadedDevice> open_to_look(std::string_view driver, Options& options, driver::OpenMode mode);

/// Opens a device with the options of a patch. `where`: position of the driver's name in the patch. Throws Error for an
/// unknown driver, with the list of all drivers, and for invalid options.
std::unique_ptr<HapticDevice> open_haptic_device(std::string_view driver, const SourceLocation& where, Options& options,
                                                 const PathResolver& resolve);

/// Returns a hardware driver's description of a device without opening it. Throws Error as open_haptic_device does.
HardwareOutline describe_haptic_device(std::string_view driver, const SourceLocation& where, Options& options,
                                       const PathResolver& resolve);

}  // namespace tactus::haptic
