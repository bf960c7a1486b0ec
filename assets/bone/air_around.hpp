// SPDX-License-Identifier: Apache-2.0
// The air that a bone's grid holds.
#pragma once

namespace tactus::bone {

inline constexpr double air_around = 5e-3;  // m, in which the distance to the surface is exact

}  // namespace tactus::bone
