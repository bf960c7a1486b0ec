// SPDX-License-Identifier: Apache-2.0
// What teeth, faces and burrs take for granted of the hand that leads them.
#pragma once

namespace tactus::saw {

inline constexpr double fastest_hand = 3.0;  // m/s: faster is a jump
inline constexpr double most_lag = 0.020;  // m: a point farther from its tool lets go
inline constexpr double dry_friction = 0.3;  // of a tool that stands still, steel on bone

}  // namespace tactus::saw
