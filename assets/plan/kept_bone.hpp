// SPDX-License-Identifier: Apache-2.0
// Cache of bones imported from meshes: computing the distances of a whole bone takes seconds, reading them a tenth of a
// second.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/core/jobs.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace tactus::plan {

/// The parts of a bone to load: all, or only those that contact and fits use, without the density.
enum class Contents { all, surface };

/// Returns the import of a closed mesh with default options, from the cache or computed and then cached; the bits are
/// equal. The density is a function of the distance (bone::assumed_density), so that it is computed and not stored.
/// `unit`: as bone::ImportOptions. Throws Error as bone::import_bone.
bone::Bone bone_of_mesh(const std::filesystem::path& path, const std::optional<std::string>& unit, Contents contents,
                        const RunJobs& run = run_in_turn);

/// Returns the cache file of this import; empty without a cache.
std::filesystem::path file_of_kept_bone(const std::filesystem::path& path, const std::optional<std::string>& unit);

}  // namespace tactus::plan
