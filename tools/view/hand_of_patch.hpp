// SPDX-License-Identifier: Apache-2.0
// Which device is the hand of a patch. No user interface.
#pragma once

#include "graph/compile/plan.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::view {

struct HandOfPatch {
    std::string node;  ///< that reads it; the first of the patch
    std::string device, driver;
    std::vector<std::string> nodes;  ///< all that name the device, or no device; at least `node`

    /// Nobody moves it: its movement is computed or recorded.
    bool moves_by_itself() const;
};
/// Of a hand on a simulated device whose table does not say it.
inline constexpr double most_of_device_N = 20.0;
/// The largest force that the hand of the patch can get: the lower one of the limits of its output and of its device, N.
double largest_force(const compile::Plan& plan);

/// None: no node reads a hand.
std::optional<HandOfPatch> hand_of(const compile::Plan& plan);

/// Takes each of `some` out of `all`, once, where it stands last.
void without_last(std::vector<std::string>& all, const std::vector<std::string>& some);

}  // namespace tactus::view
