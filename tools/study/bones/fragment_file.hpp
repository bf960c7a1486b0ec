// SPDX-License-Identifier: Apache-2.0
// Fragments from files: bones as they are, everything else through import.
#pragma once

#include "assets/bone/bone.hpp"

#include <array>
#include <filesystem>

namespace tactus::study {

/// A bone file ("FILE.vdb#NAME" for one of several), or what import makes of a mesh or a CT.
bone::Bone bone_of_file(const std::filesystem::path& path);

/// A pose as files and programs are told it; w not negative.
struct PoseNumbers {
    std::array<double, 3> position_mm;
    std::array<double, 4> quaternion_wxyz;
};
PoseNumbers numbers_of(const Pose& pose);

}  // namespace tactus::study
