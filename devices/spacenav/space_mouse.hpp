// SPDX-License-Identifier: Apache-2.0
// Driver "space_mouse": a 3D mouse whose cap commands the velocity of a hand. It has no motors; the hand yields to
// force like that of the driver "mouse".
#pragma once

#include "devices/driver/backend.hpp"
#include "graph/node/options.hpp"

#include <memory>

namespace tactus::spacenav {

/// Options: socket, speed, turn_speed, reach, and those of the hand. Throws Error.
std::unique_ptr<driver::Backend> make_space_mouse(Options& options);

}  // namespace tactus::spacenav
