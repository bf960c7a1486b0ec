// SPDX-License-Identifier: Apache-2.0
// Driver "gamepad": a hand that the sticks of a gamepad move, held by a spring that yields to force; the gamepad
// signals the force by rumbling. It uses Linux evdev on its own thread, so that neither a tick nor a frame waits for
// it.
#pragma once

#include "devices/evdev/event_system.hpp"
#include "devices/haptic/catalogue.hpp"
#include "devices/haptic/replay.hpp"
#include "graph/node/device.hpp"
#include "graph/node/options.hpp"

#include <array>
#include <cstdint>
#include <memory>

namespace tactus::haptic {

/// State of a gamepad: sticks and triggers, −1 to 1, and buttons.
struct PadState {
    /// Left stick x, y; right stick x, y; left and right trigger (0 to 1); cross x, y.
    std::array<double, 8> axes{};
    std::int64_t buttons = 0;  ///< bits of DeviceSample::buttons
    std::int64_t rolls = 0;  ///< bit 0: left shoulder, bit 1: right shoulder
    std::int64_t is_lost = 0;
};

/// Returns the commanded velocity of the hand in the axes of the device: the left stick moves it along x and z, the
/// triggers along y (right: away), the right stick turns it about z and x, the shoulder buttons about y. Sticks have a
/// dead zone of a tenth of their travel.
Twist twist_of(const PadState& state, double speed_m_s, double turn_rad_s) noexcept;

/// Options: file (an event device; without one the first gamepad in /dev/input), speed (100 mm/s), turn (1.5 rad/s),
/// rumble (10 N: the force of full rumble; 0: no rumble), and those of HandDynamics. Without `grip` and `stiffness` the
/// grip is a firm one of 2 N/mm. Throws Error when there is no gamepad.
std::unique_ptr<HapticDevice> open_gamepad(Options& options, const PathResolver& resolve);
/// The same with another system, which must outlive the device.
std::unique_ptr<HapticDevice> open_gamepad_of(evdev::EventSystem& system, Options& options);

/// Describes the hand without opening a gamepad.
HardwareOutline describe_gamepad(Options& options, const PathResolver& resolve);

}  // namespace tactus::haptic
