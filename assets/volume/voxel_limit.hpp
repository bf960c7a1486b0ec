// SPDX-License-Identifier: Apache-2.0
// How large a volume may be.
#pragma once

namespace tactus::volume {

inline constexpr double max_voxels = 1e9;

}  // namespace tactus::volume
