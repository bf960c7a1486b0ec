// SPDX-License-Identifier: Apache-2.0
// A haptic device that a test plays: what it reports is a function, what would reach the hand is kept.
#pragma once

#include "devices/haptic/catalogue.hpp"

#include <functional>
#include <string>
#include <vector>

namespace tactus::test {

/// What a played device does. Lives in the test; a device refers to it.
struct Performance {
    DeviceInfo info{.name = "played", .max_force = 20.0, .max_torque = 1.0, .damping = 2.0, .actuates_torque = true};
    /// The sample of the `count`-th acquire, after `elapsed_s` under `force`.
    std::function<DeviceSample(std::int64_t count, double elapsed_s, const Wrench& force)> acquire;
    std::function<void(const Wrench&)> commit;  ///< may be empty
};

/// Makes the driver `name` open devices that play `performance`, until another takes the name.
void play_as(const std::string& name, Performance& performance);

}  // namespace tactus::test
