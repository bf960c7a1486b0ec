// SPDX-License-Identifier: Apache-2.0
// Driver "scripted": a hand that means to be at given places at given times, and yields to force on the way.
#pragma once

#include "devices/haptic/replay.hpp"
#include "graph/node/device.hpp"
#include "graph/node/options.hpp"

#include <memory>

namespace tactus::haptic {

/// Options: targets ("0 s: 0 0 0 mm; 2 s: 0 0 -30 mm, 0 0 15 deg": times, positions, and turns about x, y, z if any),
/// wiggle, wiggle_turn, wiggle_rate, trigger_on, trigger_off, buttons ("1 s: trigger; 3 s: trigger second; 4 s:": what is
/// held from a time on), file (an asset: one target a line, with what is held from then on behind a bar), and those of
/// HandDynamics. Throws Error.
std::unique_ptr<HapticDevice> open_scripted(Options& options, const PathResolver& resolve);

}  // namespace tactus::haptic
