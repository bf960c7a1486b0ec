// SPDX-License-Identifier: Apache-2.0
// Driver "scripted": a simulated hand that moves to given poses at given times and yields to force.
#pragma once

#include "devices/haptic/replay.hpp"
#include "graph/node/device.hpp"
#include "graph/node/options.hpp"

#include <memory>

namespace tactus::haptic {

/// Options: targets ("0 s: 0 0 0 mm; 2 s: 0 0 -30 mm, 0 0 15 deg": times, positions, and optional rotations about x, y,
/// z), wiggle, wiggle_turn, wiggle_rate, trigger_on, trigger_off, buttons ("1 s: trigger; 3 s: trigger second; 4 s:":
/// the buttons held from a time on), file (an asset: one target per line, with the held buttons after '|'), and those
/// of HandDynamics. Throws Error.
std::unique_ptr<HapticDevice> open_scripted(Options& options, const PathResolver& resolve);

}  // namespace tactus::haptic
