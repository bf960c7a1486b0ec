// SPDX-License-Identifier: Apache-2.0
// A bone of which only the part near it is stored: what an import makes, and what its file holds.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/core/jobs.hpp"

#include <array>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

namespace tactus::bone {

/// Distance and density in blocks of 8 x 8 x 8 samples; no block where all samples are `outside` the bone. Memory is that of
/// the blocks, and one pointer per block of the box around the bone.
struct SparseBone {
    static constexpr int side = 8;
    struct Block {
        std::array<float, side * side * side> distance, density;  ///< x fastest; m, kg/m³
    };

    volume::Grid layout;  ///< size, origin and spacing; no values
    float outside = 0.0f;  ///< m: distance where no block is stored; none is longer. The density there is 0
    std::vector<std::unique_ptr<Block>> blocks;  ///< x fastest

    explicit SparseBone(volume::Grid size_and_place = {}, float outside_of_blocks = 0.0f);
    std::array<int, 3> blocks_per_axis() const;
    std::size_t block_index(int bx, int by, int bz) const;
    std::size_t stored() const;  ///< blocks

    /// Takes layers that start at a block's border and end at one or at the last: stores those blocks that reach nearer to
    /// the bone than `outside`.
    void add_layers(int first, const volume::Grid& distance, const volume::Grid& density, const RunJobs& run);
    /// Distance of the samples from `low` on, as many as fit in `into`; beyond the last sample the last one again.
    void copy_distance(const std::array<int, 3>& low, volume::Grid& into) const;
};

/// All samples; only the distance.
Bone dense_of(const SparseBone& sparse);
volume::Grid dense_distance_of(const SparseBone& sparse);

/// Volume (m³) and area (m²) of the surface, and the densities of the samples inside.
struct BoneMeasures {
    double volume = 0.0, area = 0.0, least = 0.0, most = 0.0, mean = 0.0;
    std::size_t inside = 0;
};
BoneMeasures measures_of(const SparseBone& bone, const RunJobs& run = run_in_turn);

/// Like save_bone; frees blocks as they are written. What stands beside the grids is taken from `about`, whose own grids
/// are not looked at.
void save_bone(SparseBone bone, const Bone& about, const std::filesystem::path& path);

}  // namespace tactus::bone
