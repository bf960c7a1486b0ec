// SPDX-License-Identifier: Apache-2.0
// Distances of a closed mesh, restricted to a region or coarse, because a whole bone in fine voxels takes seconds.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/volume/grid.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <string>

namespace tactus::bone {

struct MeshPart {
    std::filesystem::path input;
    std::optional<std::string> unit;  ///< "mm", "cm" or "m"; default: as import_bone
    bool is_coarse = false;  ///< voxels of twice the width of an import
    std::optional<std::array<Vec3, 2>> within;  ///< m, corners of a box; default: all
    bool is_surface_only = false;  ///< exact only within three voxels of the surface, which suffices to sample it
    RunJobs run = run_in_turn;
};

/// Signed distance, m, negative inside. Unless coarse, its samples are those of import_bone; with a box, distances may
/// be slightly larger beyond a few millimetres from the surface. Throws Error as import_bone.
volume::Grid distance_of_mesh(const MeshPart& part);

/// The bone that import_bone makes of a whole closed mesh with default options, without its density and measurements.
/// Throws Error as import_bone.
Bone shape_of_mesh(const std::filesystem::path& path, const std::optional<std::string>& unit, const RunJobs& run);

}  // namespace tactus::bone
