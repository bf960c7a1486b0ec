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
/// None: no node reads a hand.
std::optional<HandOfPatch> hand_of(const compile::Plan& plan);

}  // namespace tactus::view
