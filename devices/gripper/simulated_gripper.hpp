// SPDX-License-Identifier: Apache-2.0
// Simulated grippers (Olsson 2015, 6.3.1 and 6.3.2), loaded by the test rig or by a squeezing hand.
#pragma once

#include "graph/node/device.hpp"
#include "graph/node/options.hpp"

#include "devices/haptic/replay.hpp"

#include <memory>

namespace tactus::gripper {

/// One finger with a walking quasi-static motor and a lever. Options: those of WalkingMotorSettings and, for both
/// grippers, held_by (rig, hand), spring, pretension, hand_stiffness, squeeze, squeeze_from, squeeze_until,
/// squeeze_rise, squeeze_period, gauge_step, gauge_noise, delay, seed, fault (none, nan, stuck, unplugged), fault_at,
/// fault_until. Throws Error.
std::unique_ptr<HapticDevice> open_walking_gripper(Options& options, const haptic::PathResolver& resolve);

/// Finger plate and thumb, each with a direct-drive traveling-wave ultrasonic motor. Options: those of
/// WaveMotorSettings, control, lever, and those above. Throws Error.
std::unique_ptr<HapticDevice> open_wave_gripper(Options& options, const haptic::PathResolver& resolve);

}  // namespace tactus::gripper
