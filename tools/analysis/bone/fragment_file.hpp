// SPDX-License-Identifier: Apache-2.0
// Loads fragments: bone files directly, other files through the import.
#pragma once

#include "assets/bone/bone.hpp"

#include <array>
#include <filesystem>

namespace tactus::analysis {

/// Loads a bone file ("FILE.vdb#NAME" for one of several), or imports a mesh or a CT.
bone::Bone bone_of_file(const std::filesystem::path& path);

/// A pose in output convention: w is not negative.
struct PoseNumbers {
    std::array<double, 3> position_mm;
    std::array<double, 4> quaternion_wxyz;
};
PoseNumbers numbers_of(const Pose& pose);

}  // namespace tactus::analysis
