// SPDX-License-Identifier: Apache-2.0
// Driver "replay": a recorded movement is what the hand intends; the hand still yields to the device's force.
#pragma once

#include "graph/node/device.hpp"
#include "graph/node/options.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace tactus::haptic {

/// Finds the file that a patch names. Throws Error when there is none.
using PathResolver = std::function<std::filesystem::path(const std::string&)>;

/// Bit of `DeviceSample::buttons`: nothing was recorded here, the hand waits or moves on to the next segment.
inline constexpr std::uint32_t button_gap = 2u;

/// Options: file, tool, trial (see TrajectorySelection), trigger (always, from, never), trigger_from, max_speed (across
/// gaps), and those of HandDynamics. Throws Error.
std::unique_ptr<HapticDevice> open_replay(Options& options, const PathResolver& resolve);

}  // namespace tactus::haptic
