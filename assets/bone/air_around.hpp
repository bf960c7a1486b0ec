// SPDX-License-Identifier: Apache-2.0
// Width of the air around a bone in its grid.
#pragma once

namespace tactus::bone {

inline constexpr double air_around = 5e-3;  // m; within it the distance to the surface is exact

}  // namespace tactus::bone
