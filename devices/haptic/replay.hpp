// SPDX-License-Identifier: Apache-2.0
// Driver "replay": a simulated hand follows a recorded movement and yields to the device's force.
#pragma once

#include "graph/node/device.hpp"
#include "graph/node/options.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace tactus::haptic {

/// Resolves the name of a file in a patch. Throws Error when it does not exist.
using PathResolver = std::function<std::filesystem::path(const std::string&)>;

/// Bit of `DeviceSample::buttons` that marks a gap of the recording: the hand waits or moves to the next segment.
inline constexpr std::uint32_t button_gap = 2u;

/// Options: file, tool, trial (see TrajectorySelection), trigger (always, from, never), trigger_from, max_speed (across
/// gaps), and those of HandDynamics. Throws Error.
std::unique_ptr<HapticDevice> open_replay(Options& options, const PathResolver& resolve);

}  // namespace tactus::haptic
