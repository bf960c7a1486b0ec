// SPDX-License-Identifier: Apache-2.0
// Bones imported from meshes, kept in the user's cache: the distances of a whole bone take seconds to compute and a tenth
// of a second to read.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/core/jobs.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace tactus::cases {

/// What is loaded of a bone: all of it, or only what contact and fits use, without the density.
enum class Contents { all, surface };

/// The import of a closed mesh with default options, from the cache or made and then kept; the same bits either way. Its
/// density is a function of the distance (bone::assumed_density), so it is computed and not kept. `unit`: as
/// bone::ImportOptions. Throws Error as bone::import_bone.
bone::Bone bone_of_mesh(const std::filesystem::path& path, const std::optional<std::string>& unit, Contents contents,
                        const RunJobs& run = run_in_turn);

/// The file that keeps this import; empty without a cache.
std::filesystem::path file_of_kept_bone(const std::filesystem::path& path, const std::optional<std::string>& unit);

}  // namespace tactus::cases
