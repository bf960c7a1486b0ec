// SPDX-License-Identifier: Apache-2.0
// Fragments from files: bones as they are, everything else through import.
#pragma once

#include "assets/bone/bone.hpp"

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

namespace tactus {

/// A bone file ("FILE.vdb#NAME" for one of several), or what import makes of a mesh or a CT.
Bone bone_of_file(const std::filesystem::path& path);

/// {position_mm, quaternion_wxyz}, w not negative.
nlohmann::ordered_json pose_json(const Pose& pose);

}  // namespace tactus
