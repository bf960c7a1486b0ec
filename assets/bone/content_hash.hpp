// SPDX-License-Identifier: Apache-2.0
// Identity of a bone, independent of its file name.
#pragma once

#include "assets/bone/bone.hpp"

#include <string>

namespace tactus::bone {

/// Returns 16 hexadecimal digits computed from grid, distance and density; name, colour and provenance are not
/// included.
std::string content_hash(const Bone& bone);

}  // namespace tactus::bone
