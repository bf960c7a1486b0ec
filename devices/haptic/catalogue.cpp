// SPDX-License-Identifier: Apache-2.0
#include "devices/haptic/catalogue.hpp"

#include "devices/gripper/serial_gripper.hpp"
#include "devices/gripper/simulated_gripper.hpp"
#include "devices/haptic/gamepad.hpp"
#include "devices/haptic/mouse.hpp"
#include "devices/haptic/scripted.hpp"
#include "devices/haptic/simulated.hpp"

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

std::unique_ptr<HapticDevice> open_haptic_device(std::string_view driver, const SourceLocation& where, Options& options,
                                                 const PathResolver& resolve) {
    return find_driver(driver, where).open(options, resolve);
}

HardwareOutline describe_haptic_device(std::string_view driver, const SourceLocation& where, Options& options,
                                       const PathResolver& resolve) {
    const HapticDriver& found = find_driver(driver, where);
    if (found.describe) return found.describe(options, resolve);
    HardwareOutline outline;
    outline.info.name = found.name;
    return outline;
}

}  // namespace tactus::haptic
