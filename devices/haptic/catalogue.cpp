// SPDX-License-Identifier: Apache-2.0
#include "devices/haptic/catalogue.hpp"

#include "devices/board/serial_board.hpp"
#include "devices/evdev/wheel.hpp"
#include "devices/forcedimension/dhd_device.hpp"
#include "devices/gripper/serial_gripper.hpp"
#include "devices/gripper/simulated_gripper.hpp"
#include "devices/haply/inverse3.hpp"
#include "devices/haptic/gamepad.hpp"
#include "devices/haptic/mouse.hpp"
#include "devices/haptic/scripted.hpp"
#include "devices/haptic/simulated.hpp"
#include "devices/openhaptics/hd_device.hpp"
#include "devices/openigtlink/tracker.hpp"
#include "devices/spacenav/space_mouse.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace tactus::haptic {

namespace {

std::vector<HapticDriver>& drivers() {
    static std::vector<HapticDriver> all{
        {"simulated", "a hand that presses a blade with a set thrust and saws",
         [](Options& options, const PathResolver&) { return open_simulated(options); }},
        {"scripted", "a hand that moves to given poses at given times and yields to force", open_scripted},
        {"replay", "a recorded movement as the intention of a hand that yields to force", open_replay},
        {.name = "mouse",
         .summary = "a hand at the window of a run (--view): mouse and keys move it, and it yields to force",
         .open = open_mouse,
         .needs_window = true},
        {"gamepad", "a hand that the sticks of a gamepad move, and that yields to force", open_gamepad, true,
         describe_gamepad},
        {"wqsm_gripper", "a simulated gripper with a walking quasi-static motor, on a rig or in a hand",
         gripper::open_walking_gripper},
        {"twum_gripper", "a simulated gripper with two traveling-wave ultrasonic motors, on a rig or in a hand",
         gripper::open_wave_gripper},
        {"serial_gripper", "a gripper with a controller on a serial port", gripper::open_serial_gripper, true,
         gripper::describe_serial_gripper},
        {.name = "force_dimension",
         .summary = "Force Dimension delta, omega, sigma, lambda and Novint Falcon, by the maker's SDK",
         .is_real = true,
         .backend = forcedimension::make_force_dimension,
         .is_untested = true},
        {.name = "touch",
         .summary = "3D Systems Touch, Touch X and PHANTOM, by OpenHaptics",
         .is_real = true,
         .backend = openhaptics::make_touch,
         .is_untested = true},
        {.name = "haply",
         .summary = "Haply Inverse3 and Minverse with a VerseGrip, by the maker's service",
         .is_real = true,
         .backend = haply::make_inverse3,
         .is_untested = true},
        {.name = "haply_2diy",
         .summary = "Haply's 2diy kit with its first board, on a serial line",
         .is_real = true,
         .backend = board::make_haply_2diy,
         .is_untested = true},
        {.name = "serial_board",
         .summary = "a Hapkit, or a pantograph of one's own, with a board that speaks Tactus' frames",
         .is_real = true,
         .backend = board::make_serial_board,
         .is_untested = true},
        {.name = "wheel",
         .summary = "a steering wheel with force feedback, by Linux evdev",
         .is_real = true,
         .backend = evdev::make_wheel,
         .is_untested = true},
        {.name = "space_mouse",
         .summary = "a hand that a 3D mouse steers, by spacenavd; it yields to force",
         .is_real = true,
         .backend = spacenav::make_space_mouse,
         .is_untested = true},
        {.name = "openigtlink",
         .summary = "a tool that a tracker or 3D Slicer follows, by OpenIGTLink; it gives no force",
         .is_real = true,
         .backend = openigtlink::make_tracker,
         .is_untested = true},
    };
    return all;
}

}  // namespace

std::span<const HapticDriver> haptic_drivers() { return drivers(); }

void add_haptic_driver(HapticDriver driver) {
    std::erase_if(drivers(), [&](const HapticDriver& known) { return known.name == driver.name; });
    drivers().push_back(std::move(driver));
}

namespace {

const HapticDriver& find_driver(std::string_view driver, const SourceLocation& where) {
    std::vector<std::string> names;
    for (const HapticDriver& one : haptic_drivers()) {
        if (one.name == driver) return one;
        names.push_back(one.name);
    }
    throw Error(where, fmt::format("there is no haptic driver '{}'{}; there are: {}", driver,
                                   did_you_mean(driver, names), fmt::join(names, ", ")));
}

}  // namespace

bool is_real_driver(std::string_view driver) {
    for (const HapticDriver& one : haptic_drivers())
        if (one.name == driver) return one.is_real;
    return false;
}

bool needs_window(std::string_view driver) {
    return std::ranges::any_of(haptic_drivers(),
                               [&](const HapticDriver& one) { return one.name == driver && one.needs_window; });
}

namespace {

/// Without the place in a patch: the text is that of the device.
std::unique_ptr<driver::ThreadedDevice> open_backend(const HapticDriver& found, Options& options,
                                                     const driver::DeviceOptions& how) {
    std::unique_ptr<driver::Backend> backend = found.backend(options);
    options.finish();
    return std::make_unique<driver::ThreadedDevice>(std::move(backend), how);
}

}  // namespace

std::unique_ptr<HapticDevice> open_haptic_device(std::string_view driver, const SourceLocation& where, Options& options,
                                                 const PathResolver& resolve) {
    const HapticDriver& found = find_driver(driver, where);
    if (!found.backend) return found.open(options, resolve);
    const double timeout = options.quantity("open_timeout", "10 s", "0.1 s", "600 s");
    driver::DeviceOptions how{.driver = found.name, .is_untested = found.is_untested};
    // Shorter than the limit of the surrounding process, because this error names the step that hangs.
    how.open_timeout = std::chrono::milliseconds(static_cast<std::int64_t>(900.0 * timeout));
    try {
        return open_backend(found, options, how);
    } catch (const driver::OpenError& error) {
        throw Error(where, fmt::format("{}: {}", options.owner(), error.message()));
    }
}

std::unique_ptr<driver::ThreadedDevice> open_to_look(std::string_view driver, Options& options, driver::OpenMode mode) {
    const HapticDriver& found = find_driver(driver, options.where());
    if (!found.backend) {
        std::string names;
        for (const HapticDriver& one : haptic_drivers())
            if (one.backend) names += (names.empty() ? "" : ", ") + one.name;
        throw Error(
            fmt::format("driver '{}' can only be tried in a run; --probe and --verify know: {}", driver, names));
    }
    driver::DeviceOptions how{.driver = found.name, .mode = mode, .is_untested = found.is_untested};
    how.ignores_confirmation = true;
    return open_backend(found, options, how);
}

HardwareOutline describe_haptic_device(std::string_view driver, const SourceLocation& where, Options& options,
                                       const PathResolver& resolve) {
    const HapticDriver& found = find_driver(driver, where);
    if (found.backend) {
        const std::unique_ptr<driver::Backend> backend = found.backend(options);
        options.finish();
        const driver::Outline outline = backend->outline();
        return {outline.info, outline.absence};
    }
    if (found.describe) return found.describe(options, resolve);
    HardwareOutline outline;
    outline.info.name = found.name;
    return outline;
}

}  // namespace tactus::haptic
