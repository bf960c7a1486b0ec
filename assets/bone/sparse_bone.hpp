// SPDX-License-Identifier: Apache-2.0
// A sparse bone: only blocks near the bone are stored. It is the result of an import and the content of bone files.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/core/jobs.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

namespace tactus::bone {

/// Distance and density in blocks of 8 x 8 x 8 samples. Blocks whose samples all have the distance `outside` are not
/// stored. Memory: the blocks, and one pointer per block of the bounding box.
struct SparseBone {
    static constexpr int side = 8;
    struct Block {
        std::array<float, side * side * side> distance, density;  ///< x fastest; m, kg/m³
    };

    volume::Grid layout;  ///< size, origin and spacing; no values
    float outside = 0.0f;  ///< m: largest distance; applies where no block is stored, with density 0
    std::vector<std::unique_ptr<Block>> blocks;  ///< x fastest

    explicit SparseBone(volume::Grid size_and_place = {}, float outside_of_blocks = 0.0f);
    std::array<int, 3> blocks_per_axis() const {
        const auto blocks_along = [&](std::size_t axis) { return (layout.size[axis] + side - 1) / side; };
        return {blocks_along(0), blocks_along(1), blocks_along(2)};
    }
    std::size_t block_index(int bx, int by, int bz) const {
        const auto per_axis = blocks_per_axis();
        return (static_cast<std::size_t>(bz) * static_cast<std::size_t>(per_axis[1]) + static_cast<std::size_t>(by)) *
                   static_cast<std::size_t>(per_axis[0]) +
               static_cast<std::size_t>(bx);
    }
    std::size_t stored() const;  ///< blocks

    /// Adds layers. They start at a block border and end at one or at the last layer. Stores the blocks that have a
    /// distance below `outside`.
    void add_layers(int first, const volume::Grid& distance, const volume::Grid& density, const RunJobs& run);
    /// Copies the distances from sample `low` on into `into`; the last sample is repeated beyond the border.
    void copy_distance(const std::array<int, 3>& low, volume::Grid& into) const;
};

/// The dense distance grid.
Bone dense_of(const SparseBone& sparse);
volume::Grid dense_distance_of(const SparseBone& sparse);

/// Volume (m³) and area (m²) of the surface, and statistics of the density inside.
struct BoneMeasures {
    double volume = 0.0, area = 0.0, least = 0.0, most = 0.0, mean = 0.0;
    std::size_t inside = 0, metal = 0;  ///< samples of bone; and denser ones, excluded from the densities
};
BoneMeasures measures_of(const SparseBone& bone, const RunJobs& run = run_in_turn);

/// Like save_bone, but frees blocks as they are written. Name, colour, provenance and points come from `about`; its
/// grids are ignored.
void save_bone(SparseBone bone, const Bone& about, const std::filesystem::path& path);

}  // namespace tactus::bone
