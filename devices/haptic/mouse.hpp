// SPDX-License-Identifier: Apache-2.0
// Driver "mouse": a hand that follows the mouse and the keys of a window, held by a spring that yields to force.
#pragma once

#include "devices/haptic/replay.hpp"
#include "devices/haptic/window_hand.hpp"
#include "graph/node/device.hpp"
#include "graph/node/options.hpp"

#include <memory>

namespace tactus::haptic {

/// Silence of the window after which the hand counts as lost: samples are late, which fades the force.
inline constexpr std::int64_t longest_silence_of_window_ns = 100'000'000;
/// Silence after which the window's buttons count as released, too. It is longer, because a single slow frame must not
/// drop the held body.
inline constexpr std::int64_t longest_hold_of_window_ns = 1'000'000'000;

/// Options: those of HandDynamics; without `grip` and `stiffness` a firm grip of 2 N/mm. `link` must outlive the device;
/// `now_ns` is the clock of its time stamps. Throws Error.
std::unique_ptr<HapticDevice> open_mouse(Options& options, WindowHand& link, std::int64_t (*now_ns)());

/// The same with the window of this process.
std::unique_ptr<HapticDevice> open_mouse(Options& options, const PathResolver& resolve);

}  // namespace tactus::haptic
