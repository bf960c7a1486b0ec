// SPDX-License-Identifier: Apache-2.0
// Small scans with known fragments.
#pragma once

#include "dsp/core/random.hpp"
#include "dsp/segmentation/gap_statistics.hpp"
#include "dsp/segmentation/random_walk.hpp"
#include "dsp/segmentation/voxel_graph.hpp"
#include "dsp/volume/grid.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tactus::test {

struct Phantom {
    volume::Grid grid;
    std::vector<std::uint8_t> inside, truth;  // per voxel

    segmentation::VoxelGraph graph() const {
        return segmentation::make_voxel_graph(grid, inside,
                                              segmentation::gap_law(segmentation::gap_statistics(grid, inside)));
    }
};

// A cube of values between 100 and 1000, all of it bone.
inline Phantom noisy_cube(int edge, std::uint64_t seed = 1) {
    Phantom p;
    p.grid = {{edge, edge, edge}, Vec3(0.0), Vec3(1e-3), {}};
    p.grid.values.resize(p.grid.count());
    for (std::size_t v = 0; v < p.grid.values.size(); ++v)
        p.grid.values[v] = static_cast<float>(100.0 + 900.0 * Random{seed}.uniform(v));
    p.inside.assign(p.grid.count(), 1);
    return p;
}

// Two blocks with a gap of one voxel at x = 20, bridged over a disc by 0.6 of the bone's contrast. Noise of 20 HU.
inline Phantom bridged_blocks(double disc_radius, std::uint64_t seed) {
    Phantom p;
    p.grid = {{41, 32, 32}, Vec3(0.0), Vec3(1e-3), {}};
    const double bone = 800.0, tissue = 50.0;
    std::size_t v = 0;
    for (int k = 0; k < 32; ++k)
        for (int j = 0; j < 32; ++j)
            for (int i = 0; i < 41; ++i, ++v) {
                const double y = j - 15.5, z = k - 15.5;
                const bool bridge = y * y + z * z <= disc_radius * disc_radius;
                const double value = i != 20 ? bone : bridge ? tissue + 0.6 * (bone - tissue) : tissue;
                p.grid.values.push_back(static_cast<float>(value + 20.0 * Random{seed}.normal(v)));
                p.inside.push_back(p.grid.values.back() >= 200.0f);
                p.truth.push_back(i < 20 ? 1 : i > 20 ? 2 : 0);
            }
    return p;
}

// Seeds at nodes with these coordinates.
inline std::vector<std::uint8_t> seeds_at(const segmentation::VoxelGraph& graph,
                                          const std::vector<std::pair<std::array<int, 3>, int>>& places) {
    std::vector<std::uint8_t> seed(graph.nodes(), 0);
    for (std::size_t n = 0; n < graph.nodes(); ++n)
        for (const auto& [place, label] : places)
            if (graph.place(n) == place) seed[n] = static_cast<std::uint8_t>(label);
    return seed;
}

}  // namespace tactus::test
