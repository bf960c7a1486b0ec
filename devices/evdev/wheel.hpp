// SPDX-License-Identifier: Apache-2.0
// Driver "wheel": a steering wheel with force feedback, by Linux evdev. Its motor gives a constant force that is
// updated in each round. The hand holds its rim at the top.
#pragma once

#include "devices/driver/backend.hpp"
#include "devices/evdev/event_system.hpp"
#include "graph/node/options.hpp"

#include <memory>

namespace tactus::evdev {

/// Options: file, range, radius, max_torque, moves, reversed, serial. Throws Error.
std::unique_ptr<driver::Backend> make_wheel(Options& options);
/// The same with another system, which must outlive the backend.
std::unique_ptr<driver::Backend> make_wheel_of(EventSystem& system, Options& options);

}  // namespace tactus::evdev
