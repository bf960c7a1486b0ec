// SPDX-License-Identifier: Apache-2.0
// Which bone it is, whatever its file is called.
#pragma once

#include "assets/bone/bone.hpp"

#include <string>

namespace tactus::bone {

/// 16 hexadecimal digits of grid, distance and density; name, colour and provenance do not count.
std::string content_hash(const Bone& bone);

}  // namespace tactus::bone
