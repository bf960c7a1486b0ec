// SPDX-License-Identifier: Apache-2.0
// A bar that shows which colour stands for which value.
#pragma once

#include "devices/display/figure.hpp"

#include <functional>
#include <string>

namespace tactus::report {

/// `colour`: sRGB from 0 to 1, of a share from 0 to 1; `least` and `most` stand at the ends.
display::Figure colour_bar(const std::function<Vec3(double share)>& colour, const std::string& least,
                           const std::string& most);

}  // namespace tactus::report
