// SPDX-License-Identifier: Apache-2.0
// Which device is the hand of a patch. No user interface.
#pragma once

#include "graph/compile/schedule.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::window {

struct HandOfPatch {
    std::string node;  ///< that reads it; the first of the patch
    std::string device, driver;
    std::vector<std::string> nodes;  ///< all that name the device, or no device; at least `node`

    /// Nobody moves it: its movement is computed or recorded.
    bool moves_by_itself() const;
};
/// Of a hand on a simulated device whose table does not say it.
inline constexpr double max_of_device_N = 20.0;
/// The device that a node of a hand means; empty: that cannot be said.
std::string device_of(const compile::Schedule& plan, const compile::ScheduleNode& node);
/// The driver of a device; one that the patch does not declare can be named as well.
std::string driver_of(const compile::Schedule& plan, const std::string& device);
/// The largest force that a hand on this device can get: the lower one of the limits of its output and of the device, N.
double largest_force(const compile::Schedule& plan, const std::string& device);
/// The same for the hand of the patch.
double largest_force(const compile::Schedule& plan);

/// None: no node reads a hand.
std::optional<HandOfPatch> hand_of(const compile::Schedule& plan);

/// Takes each of `some` out of `all`, once, where it stands last.
void without_last(std::vector<std::string>& all, const std::vector<std::string>& some);

}  // namespace tactus::window
